#pragma once

#include <cstddef>

namespace nuvo {

/// Asks for the cache lines of `bytes` from `at` on. (As a call g++ would take it for one without
/// effects, and leave it out.)
[[gnu::always_inline]] inline void prefetch_lines(const void* at, std::size_t bytes) {
    constexpr std::size_t kLine = 64;
    for (std::size_t i = 0; i < bytes; i += kLine)
        __builtin_prefetch(static_cast<const char*>(at) + i);
}

}  // namespace nuvo
