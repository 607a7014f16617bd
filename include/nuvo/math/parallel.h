#pragma once

#include <cstddef>
#include <functional>

namespace nuvo {

/// Calls work(index, thread) for every index below `count`, on up to `threads` threads at a time
/// (the caller's among them) that take the next index from a shared counter; 0 <= thread < threads.
/// Where the system refuses threads there are fewer.
/// Throws what the first failing call threw, when all threads have ended.
void for_each_index(int threads, std::size_t count,
                    const std::function<void(std::size_t index, int thread)>& work);

/// Calls work(begin, end) for parts of [0, count), which do not depend on `threads`.
void for_each_part(int threads, std::size_t count,
                   const std::function<void(std::size_t begin, std::size_t end)>& work);

}  // namespace nuvo
