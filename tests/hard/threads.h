#pragma once

#include <algorithm>
#include <thread>

namespace nuvo::hard {

/// So many threads; 0: as many as the machine has.
inline int thread_count(unsigned threads) {
    return static_cast<int>(threads > 0 ? threads
                                        : std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace nuvo::hard
