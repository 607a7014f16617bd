#include "nuvo/math/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace nuvo {
namespace {

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
        std::vector<std::jthread> others;
        try {
            for (int thread = 1; thread < useful; ++thread)
                others.emplace_back([&loop, thread] { loop.run(thread); });
        } catch (const std::system_error&) {
            // The system has no more threads: those that there are do the work.
        }
        loop.run(0);
    }
    loop.rethrow();
}

void for_each_part(int threads, std::size_t count,
                   const std::function<void(std::size_t, std::size_t)>& work) {
    constexpr std::size_t kPart = 8192;
    for_each_index(threads, (count + kPart - 1) / kPart,
                   [&](std::size_t i, int) { work(i * kPart, std::min(count, (i + 1) * kPart)); });
}

}  // namespace nuvo
