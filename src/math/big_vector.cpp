#include "nuvo/math/big_vector.h"

#include <algorithm>
#include <bit>
#include <mutex>

#if defined(__linux__)
#include <sys/mman.h>
#endif
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace nuvo {
namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21;
constexpr std::size_t kLeastKept = std::size_t{1} << 16;  // smaller ones the heap keeps

std::align_val_t alignment(std::size_t size) {
    return std::align_val_t{size < kLargePage ? 64 : kLargePage};
}

// Blocks that wait for their next use. Sizes are powers of two, so that blocks of about the same
// size do for each other; pages that are never touched cost nothing.
class KeptBlocks {
  public:
    void add_keeper() {
        const std::lock_guard lock(mutex_);
        ++keepers_;
    }
    void drop_keeper() {
        const std::lock_guard lock(mutex_);
        if (--keepers_ > 0) return;
        for (const Block& block : blocks_) ::operator delete(block.at, alignment(block.size));
        blocks_.clear();
    }

    std::size_t bytes() {
        const std::lock_guard lock(mutex_);
        std::size_t sum = 0;
        for (const Block& block : blocks_) sum += block.used;
        return sum;
    }

    void* take(std::size_t size) {
        const std::lock_guard lock(mutex_);
        // The last one: it is most likely still in a cache.
        const auto found = std::find_if(blocks_.rbegin(), blocks_.rend(),
                                        [&](const Block& block) { return block.size == size; });
        if (found == blocks_.rend()) return nullptr;
        void* const at = found->at;
        blocks_.erase(std::prev(found.base()));
        return at;
    }
    /// False: to be freed.
    bool keep(void* at, std::size_t size, std::size_t used) noexcept {
        const std::lock_guard lock(mutex_);
        if (keepers_ == 0) return false;
        try {
            blocks_.push_back({at, size, used});
        } catch (const std::bad_alloc&) {
            return false;
        }
        return true;
    }

  private:
    struct Block {
        void* at;
        std::size_t size;
        std::size_t used;  // by the last use
    };

    std::mutex mutex_;
    int keepers_ = 0;
    std::vector<Block> blocks_;
};

KeptBlocks& kept_blocks() {
    static KeptBlocks blocks;
    return blocks;
}

}  // namespace

BlockKeeper::BlockKeeper() { kept_blocks().add_keeper(); }
BlockKeeper::~BlockKeeper() { kept_blocks().drop_keeper(); }

std::size_t kept_block_bytes() { return kept_blocks().bytes(); }

void trim_heap() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
}

void* allocate_block(std::size_t bytes) {
    if (bytes < kLeastKept) return ::operator new(bytes, alignment(bytes));
    const std::size_t size = std::bit_ceil(bytes);
    if (void* const kept = kept_blocks().take(size)) return kept;
    void* const at = ::operator new(size, alignment(size));
#if defined(__linux__)
    if (size >= kLargePage) madvise(at, size, MADV_HUGEPAGE);  // a wish, no more
#endif
    return at;
}

void free_block(void* at, std::size_t bytes) noexcept {
    if (bytes < kLeastKept) return ::operator delete(at, alignment(bytes));
    const std::size_t size = std::bit_ceil(bytes);
    if (!kept_blocks().keep(at, size, bytes)) ::operator delete(at, alignment(size));
}

}  // namespace nuvo
