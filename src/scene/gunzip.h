#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace nuvo::x3d {

/// True for bytes that gzip has packed.
bool is_gzip(std::string_view bytes);

/// What gzip packed into `bytes` (RFC 1952, several members one after the other). Throws Error
/// where the bytes are damaged, and as soon as they unpack to more than `limit`; `file` stands for
/// them in messages.
std::string gunzip(std::string_view bytes, const std::string& file, std::size_t limit);

}  // namespace nuvo::x3d
