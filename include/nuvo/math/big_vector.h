#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace nuvo {

/// While one of these lives, freed blocks of 64 KiB and more stay with the process and are handed
/// out again: the system would have to fill them with zeros first, which takes as long as to make
/// a table. Held by a tracer, whose frames need the same blocks one after another, and the first
/// one those of the octree's construction.
class BlockKeeper {
  public:
    BlockKeeper();
    ~BlockKeeper();
    BlockKeeper(const BlockKeeper&) = delete;
    BlockKeeper& operator=(const BlockKeeper&) = delete;
};

/// Bytes of freed blocks that stay.
std::size_t kept_block_bytes();

/// Gives what the heap holds free back to the system, where the C library can: after work with
/// millions of small blocks, which else stay between those in use.
void trim_heap();

/// Memory aligned to 64 bytes, for a multiple of megabytes to a large page.
void* allocate_block(std::size_t bytes);
void free_block(void* at, std::size_t bytes) noexcept;

/// For tables of many megabytes that are read all over: asks the system for large pages, which
/// spares it most page faults and the processor most address look-ups; and leaves the elements
/// uninitialized where a vector would write zeros first.
template <typename T>
struct BigAllocator {
    using value_type = T;

    BigAllocator() = default;
    template <typename U>
    BigAllocator(const BigAllocator<U>&) {}  // NOLINT(google-explicit-constructor): an allocator

    T* allocate(std::size_t n) { return static_cast<T*>(allocate_block(n * sizeof(T))); }
    void deallocate(T* at, std::size_t n) { free_block(at, n * sizeof(T)); }
    /// No value given: none written, not even that of a member's initializer. Storage from
    /// allocate() holds objects of such types by itself (C++20, implicit-lifetime types).
    template <typename U>
    void construct(U* at) {
        if constexpr (!std::is_trivially_copyable_v<U>) ::new (static_cast<void*>(at)) U;
    }
    template <typename U, typename... Arguments>
    void construct(U* at, Arguments&&... arguments) {
        ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
    }
    friend bool operator==(const BigAllocator&, const BigAllocator&) { return true; }
};

/// resize() leaves new elements unset if T is trivially copyable.
template <typename T>
using BigVector = std::vector<T, BigAllocator<T>>;

/// Bytes that the vector holds for its elements.
template <typename T, typename Allocator>
std::size_t vector_bytes(const std::vector<T, Allocator>& values) {
    return values.capacity() * sizeof(T);
}

}  // namespace nuvo
