#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "nuvo/math/big_vector.h"

namespace nuvo::x3d {

/// The bytes of a file.
using Text = BigVector<char>;
inline std::string_view view(const Text& text) { return {text.data(), text.size()}; }

/// True for bytes that gzip has packed.
bool is_gzip(std::string_view bytes);

/// What gzip packed into `bytes` (RFC 1952, several members one after the other). Throws Error
/// where the bytes are damaged, and as soon as they unpack to more than `limit`; `file` stands for
/// them in messages.
Text gunzip(std::string_view bytes, const std::string& file, std::size_t limit);

}  // namespace nuvo::x3d
