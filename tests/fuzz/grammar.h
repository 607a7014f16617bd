#pragma once

#include <cstdint>

#include "document.h"

namespace nuvo::fuzz {

/// The document of that number: rooms with thin things in them, free trees, things that coincide,
/// fans seen and lit from their tips, far apart things; at any scale. Mostly valid; some are
/// refused by the loader.
Document make_document(std::uint64_t seed);

}  // namespace nuvo::fuzz
