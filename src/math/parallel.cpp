#include "nuvo/math/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#if defined(__linux__)
#include <sched.h>
#endif

namespace nuvo {
namespace {

// The system likes to put a new thread on the processor of the one that makes it, where it waits
// until the system balances its load: longer than many a loop takes. So a new thread leaves that
// processor first, if there are others, and its maker lets it go ahead.
class Processor {
  public:
#if defined(__linux__)
    /// The caller's.
    Processor() : number_(sched_getcpu()) {}

    void leave() const {
        cpu_set_t all;
        if (number_ < 0 || sched_getcpu() != number_) return;
        if (sched_getaffinity(0, sizeof all, &all) != 0 || CPU_COUNT(&all) < 2) return;
        cpu_set_t others = all;
        CPU_CLR(static_cast<unsigned>(number_), &others);
        if (sched_setaffinity(0, sizeof others, &others) == 0)
            sched_setaffinity(0, sizeof all, &all);
    }

  private:
    int number_;
#else
    void leave() const {}
#endif
};

class Loop {
  public:
    Loop(std::size_t count, const std::function<void(std::size_t, int)>& work)
        : count_(count), work_(work) {}

    void run(int thread) {
        try {
            for (std::size_t i = next_++; i < count_; i = next_++) work_(i, thread);
        } catch (...) {
            next_ = count_;
            const std::lock_guard lock(mutex_);
            if (!error_) error_ = std::current_exception();
        }
    }
    void rethrow() const {
        if (error_) std::rethrow_exception(error_);
    }

  private:
    std::size_t count_;
    const std::function<void(std::size_t, int)>& work_;
    std::atomic<std::size_t> next_ = 0;
    std::mutex mutex_;
    std::exception_ptr error_;
};

}  // namespace

void for_each_index(int threads, std::size_t count,
                    const std::function<void(std::size_t, int)>& work) {
    Loop loop(count, work);
    const auto useful = static_cast<int>(std::min(static_cast<std::size_t>(threads), count));
    {
        const Processor here;
        std::vector<std::jthread> others;
        try {
            for (int thread = 1; thread < useful; ++thread)
                others.emplace_back([&loop, here, thread] {
                    here.leave();
                    loop.run(thread);
                });
            if (!others.empty()) std::this_thread::yield();
        } catch (const std::system_error&) {
            // The system has no more threads: those that there are do the work.
        }
        loop.run(0);
    }
    loop.rethrow();
}

void for_each_part(int threads, std::size_t count,
                   const std::function<void(std::size_t, std::size_t)>& work) {
    constexpr std::size_t kPart = 2048;
    for_each_index(threads, (count + kPart - 1) / kPart,
                   [&](std::size_t i, int) { work(i * kPart, std::min(count, (i + 1) * kPart)); });
}

}  // namespace nuvo
