#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace nuvo {

/// For tables of many megabytes that are read all over: asks the system for large pages, which
/// spares it most page faults and the processor most address look-ups; and leaves the elements
/// uninitialized where a vector would write zeros first.
template <typename T>
struct BigAllocator {
    using value_type = T;
    static constexpr std::size_t kLargePage = std::size_t{1} << 21;

    BigAllocator() = default;
    template <typename U>
    BigAllocator(const BigAllocator<U>&) {}  // NOLINT(google-explicit-constructor): an allocator

    T* allocate(std::size_t n) {
        const std::size_t bytes = n * sizeof(T);
        void* const at = ::operator new(bytes, alignment(bytes));
#if defined(__linux__)
        if (bytes >= kLargePage) madvise(at, bytes, MADV_HUGEPAGE);  // a wish, no more
#endif
        return static_cast<T*>(at);
    }
    void deallocate(T* at, std::size_t n) {
        const std::size_t bytes = n * sizeof(T);
        ::operator delete(at, alignment(bytes));
    }
    /// No value given: none written.
    template <typename U>
    void construct(U* at) {
        ::new (static_cast<void*>(at)) U;
    }
    template <typename U, typename... Arguments>
    void construct(U* at, Arguments&&... arguments) {
        ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
    }
    friend bool operator==(const BigAllocator&, const BigAllocator&) { return true; }

  private:
    static std::align_val_t alignment(std::size_t bytes) {
        return std::align_val_t{bytes >= kLargePage ? kLargePage : std::size_t{64}};
    }
};

/// T should be trivial; resize() leaves its members unset.
template <typename T>
using BigVector = std::vector<T, BigAllocator<T>>;

}  // namespace nuvo
