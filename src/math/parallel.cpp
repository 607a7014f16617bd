#include "nuvo/math/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "nuvo/math/signals_blocked.h"

#if defined(__linux__)
#include <sched.h>
#endif

// A picture of a few milliseconds is made by several loops. Threads stay between them, awake for a
// while: to start one, or to wake one up, takes as long as some of the loops.

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

// The system likes to let a thread begin on the processor of the one that starts it, where it waits
// until the system balances its load: longer than many a loop takes. So a thread leaves that
// processor first, if there are others, and its starter lets it go ahead.
class Processor {
  public:
#if defined(__linux__)
    /// The caller's.
    static Processor here() { return Processor(sched_getcpu()); }

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
    explicit Processor(int number) : number_(number) {}

    int number_;
#else
    static Processor here() { return {}; }
    void leave() const {}
#endif
};

/// A thread that runs loops for others.
class Helper {
  public:
    Helper() : thread_([this] { serve(); }) {}
    ~Helper() {
        loop_ = nullptr;
        ticket_.fetch_add(1);
        ticket_.notify_one();
    }

    /// Returns whether it has to be woken up.
    bool start(Loop& loop, int thread, const Processor& starter) {
        loop_ = &loop;
        number_ = thread;
        starter_ = starter;
        const bool asleep = asleep_;
        ticket_.fetch_add(1);
        ticket_.notify_one();
        return asleep;
    }
    void wait() const {
        const std::uint32_t last = ticket_;
        for (int i = 0; i < kSpins; ++i)
            if (done_ == last) return;
        for (std::uint32_t done = done_; done != last; done = done_) done_.wait(done);
    }

  private:
    static constexpr int kSpins = 1 << 13;  // a fraction of a millisecond

    void serve() {
        for (std::uint32_t seen = 0;;) {
            for (int i = 0; i < kSpins && ticket_ == seen && !asleep_; ++i) pause();
            const bool slept = asleep_ || ticket_ == seen;
            asleep_ = slept;
            ticket_.wait(seen);
            asleep_ = false;
            ++seen;
            if (loop_ == nullptr) return;
            if (slept) starter_.leave();
            loop_->run(number_);
            done_ = seen;
            done_.notify_one();
        }
    }
    static void pause() {
#if defined(__x86_64__)
        __builtin_ia32_pause();
#endif
    }

    std::atomic<std::uint32_t> ticket_ = 0;  // of the last loop that was asked for
    std::atomic<std::uint32_t> done_ = 0;
    std::atomic<bool> asleep_ = true;
    Loop* loop_ = nullptr;
    int number_ = 0;
    Processor starter_ = Processor::here();
    std::jthread thread_;  // the last member: it uses the others
};

/// The threads that are kept.
class Team {
  public:
    /// Runs `loop` on the caller's thread and up to `others` more.
    void run(Loop& loop, int others) {
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock) return loop.run(0);  // a loop within a loop: all threads are at work
        try {
            const std::size_t wanted = std::min(static_cast<std::size_t>(others), most_);
            const SignalsBlocked blocked;  // handlers run on the main thread, which may hold them
            while (helpers_.size() < wanted) helpers_.push_back(std::make_unique<Helper>());
        } catch (const std::exception&) {
            // The system has no more threads (std::system_error), or no more addresses for their
            // stacks, and then perhaps no memory to say so (std::bad_alloc). A thread that
            // asks for memory takes up to eight times as many addresses again (64 MB of glibc's
            // beside a stack of 8): so a few do the work, and leave the others' memory to it.
            most_ = helpers_.size() / 16;
            helpers_.resize(most_);
        }
        const std::size_t used = std::min(helpers_.size(), static_cast<std::size_t>(others));
        const Processor here = Processor::here();
        bool asleep = false;
        for (std::size_t i = 0; i < used; ++i)
            asleep |= helpers_[i]->start(loop, static_cast<int>(i) + 1, here);
        if (asleep) std::this_thread::yield();
        loop.run(0);
        for (std::size_t i = 0; i < used; ++i) helpers_[i]->wait();
    }

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<Helper>> helpers_;
    std::size_t most_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace

void for_each_index(int threads, std::size_t count,
                    const std::function<void(std::size_t, int)>& work) {
    static Team team;
    Loop loop(count, work);
    const auto useful = static_cast<int>(std::min(static_cast<std::size_t>(threads), count));
    if (useful > 1)
        team.run(loop, useful - 1);
    else
        loop.run(0);
    loop.rethrow();
}

void for_each_part(int threads, std::size_t count,
                   const std::function<void(std::size_t, std::size_t)>& work) {
    constexpr std::size_t kPart = 2048;
    for_each_index(threads, (count + kPart - 1) / kPart,
                   [&](std::size_t i, int) { work(i * kPart, std::min(count, (i + 1) * kPart)); });
}

}  // namespace nuvo
