#include "meter.h"

#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>

#include "text.h"

namespace nuvo::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr Clock::duration kSilence = std::chrono::seconds(1);
constexpr Clock::duration kBetweenLines = std::chrono::milliseconds(100);
constexpr std::string_view kEraseLine = "\r\033[K";

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string duration_text(double seconds) {
    constexpr double kMinute = 60, kHour = 3600;
    if (seconds < 2 * kMinute) return format("%.0f s", seconds);
    if (seconds < 2 * kHour) return format("%.0f min", seconds / kMinute);
    return format("%.0f h", seconds / kHour);
}

std::string rate_text(double pieces, const char* unit) {
    constexpr double kMillion = 1e6, kThousand = 1e3;
    if (pieces >= kMillion) return format("%.3g million %s/s", pieces / kMillion, unit);
    if (pieces >= kThousand) return format("%.3g thousand %s/s", pieces / kThousand, unit);
    return format("%.3g %s/s", pieces, unit);
}

/// None where nothing is known yet.
std::optional<double> seconds_left(const MeterReading& now) {
    std::optional<double> of_work;
    if (now.done > 0 && now.total > 0) {
        const double share = static_cast<double>(now.done) / static_cast<double>(now.total);
        of_work = std::max(0.0, now.seconds / share - now.seconds);
    }
    if (now.number == 0) return of_work;
    const auto finished = static_cast<double>(now.number - 1);
    const auto parts = static_cast<double>(now.parts);
    // A part is as long as those before it; the first one ends with this work.
    if (finished > 0)
        return std::max(0.0, now.before_seconds / finished * (parts - finished) - now.part_seconds);
    if (!of_work) return std::nullopt;
    return (now.part_seconds + *of_work) * parts - now.part_seconds;
}

void write_to_terminal(std::string_view text) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    static_cast<void>(written);  // a line that is lost is replaced by the next one
}

}  // namespace

std::string meter_line(const MeterReading& now) {
    std::string line;
    if (now.number > 0) line += format("%s %zu of %zu: ", now.part, now.number, now.parts);
    line += now.title;
    std::string facts;
    const auto tell = [&facts](const std::string& fact) {
        facts += (facts.empty() ? ": " : ", ") + fact;
    };
    if (now.total > 0) {
        const std::uint64_t done = std::min(now.done, now.total);
        tell(format("%.0f %%", 100 * static_cast<double>(done) / static_cast<double>(now.total)));
    }
    if (now.done > 0 && now.seconds > 0)
        tell(rate_text(static_cast<double>(now.done) / now.seconds, now.unit));
    if (const std::optional<double> left = seconds_left(now)) tell(duration_text(*left) + " left");
    return line + facts;
}

class Meter::Shown {
  public:
    Shown() : start_(Clock::now()), thread_([this] { show(); }) {}
    ~Shown() {
        end();
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
        }
        wake_.notify_one();
        thread_.join();
    }

    Progress* begin(const std::string& title) {
        const std::lock_guard lock(mutex_);
        progress_.begin("", 0);
        title_ = title;
        work_start_ = Clock::now();
        return &progress_;
    }
    void begin_part(const char* part, std::size_t number, std::size_t parts) {
        const std::lock_guard lock(mutex_);
        title_.clear();
        part_ = part;
        number_ = parts > 1 ? number : 0;
        parts_ = parts;
        part_start_ = Clock::now();
        if (number == 1) first_part_start_ = part_start_;
    }
    void end() {
        const std::lock_guard lock(mutex_);
        title_.clear();
        number_ = 0;
        if (is_written_) write_to_terminal(kEraseLine);
        is_written_ = false;
    }

  private:
    void show() {
        try {
            show_lines();
        } catch (const std::bad_alloc&) {  // the work goes before
        }
    }
    void show_lines() {
        std::unique_lock lock(mutex_);
        if (wake_.wait_until(lock, start_ + kSilence, [this] { return over_; })) return;
        do {
            if (title_.empty()) continue;
            const std::string line = std::string(kEraseLine) + meter_line(reading());
            write_to_terminal(line);
            is_written_ = true;
        } while (!wake_.wait_for(lock, kBetweenLines, [this] { return over_; }));
    }
    MeterReading reading() const {
        MeterReading now;
        now.title = title_;
        now.unit = progress_.unit();
        now.done = progress_.done();
        now.total = progress_.total();
        now.seconds = seconds_since(work_start_);
        if (number_ == 0) return now;
        now.part = part_;
        now.number = number_;
        now.parts = parts_;
        now.part_seconds = seconds_since(part_start_);
        now.before_seconds = seconds_since(first_part_start_) - now.part_seconds;
        return now;
    }

    const Clock::time_point start_;
    Progress progress_;
    std::mutex mutex_;  // for what follows
    std::condition_variable wake_;
    std::string title_;  // empty: no work is on
    Clock::time_point work_start_;
    const char* part_ = "";
    std::size_t number_ = 0;
    std::size_t parts_ = 0;
    Clock::time_point part_start_;
    Clock::time_point first_part_start_;
    bool is_written_ = false;
    bool over_ = false;
    std::thread thread_;  // the last member: it uses the others
};

Meter::Meter(bool wanted) {
    if (!wanted || ::isatty(STDERR_FILENO) == 0) return;
    try {
        shown_ = std::make_unique<Shown>();
    } catch (const std::system_error&) {  // no thread to be had: the work goes before
    }
}

Meter::~Meter() = default;

Progress* Meter::begin(const std::string& title) { return shown_ ? shown_->begin(title) : nullptr; }

void Meter::begin_part(const char* part, std::size_t number, std::size_t parts) {
    if (shown_) shown_->begin_part(part, number, parts);
}

void Meter::end() {
    if (shown_) shown_->end();
}

}  // namespace nuvo::app
