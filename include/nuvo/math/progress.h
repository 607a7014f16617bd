#pragma once

#include <atomic>
#include <cstdint>

namespace nuvo {

/// How far a long work is: told in pieces by the threads that do it, read by anybody meanwhile.
/// Functions that take a Progress* take null for none.
class Progress {
  public:
    /// Another work begins, of at most `total` pieces (0: nobody knows) named `unit`, in the plural
    /// and of static storage.
    void begin(const char* unit, std::uint64_t total) {
        total_.store(total, std::memory_order_relaxed);
        done_.store(0, std::memory_order_relaxed);
        unit_.store(unit, std::memory_order_relaxed);
    }
    void add(std::uint64_t pieces) { done_.fetch_add(pieces, std::memory_order_relaxed); }

    const char* unit() const { return unit_.load(std::memory_order_relaxed); }
    std::uint64_t total() const { return total_.load(std::memory_order_relaxed); }
    std::uint64_t done() const { return done_.load(std::memory_order_relaxed); }

  private:
    std::atomic<const char*> unit_ = "";
    std::atomic<std::uint64_t> total_ = 0;
    std::atomic<std::uint64_t> done_ = 0;
};

inline void begin(Progress* progress, const char* unit, std::uint64_t total) {
    if (progress != nullptr) progress->begin(unit, total);
}
inline void add(Progress* progress, std::uint64_t pieces) {
    if (progress != nullptr) progress->add(pieces);
}

}  // namespace nuvo
