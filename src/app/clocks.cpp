#include "nuvo/app/clocks.h"

#include <boost/chrono.hpp>
#include <ctime>

namespace nuvo::app {
namespace {

namespace bc = boost::chrono;

template <typename Clock>
std::int64_t nanoseconds_now() {
    return bc::duration_cast<bc::nanoseconds>(Clock::now().time_since_epoch()).count();
}

/// Boost's clocks of the whole process move in the system's steps.
std::int64_t process_nanoseconds_now() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

double to_seconds(std::int64_t nanoseconds) { return static_cast<double>(nanoseconds) / 1e9; }

}  // namespace

ProcessStopwatch::ProcessStopwatch()
    : user_ns_(nanoseconds_now<bc::process_user_cpu_clock>()),
      system_ns_(nanoseconds_now<bc::process_system_cpu_clock>()),
      wall_ns_(nanoseconds_now<bc::steady_clock>()) {}

ProcessTimes ProcessStopwatch::elapsed() const {
    return {to_seconds(nanoseconds_now<bc::process_user_cpu_clock>() - user_ns_),
            to_seconds(nanoseconds_now<bc::process_system_cpu_clock>() - system_ns_),
            to_seconds(nanoseconds_now<bc::steady_clock>() - wall_ns_)};
}

StageStopwatch::StageStopwatch()
    : start_ns_(process_nanoseconds_now()), wall_start_ns_(nanoseconds_now<bc::steady_clock>()) {}

double StageStopwatch::seconds() const { return to_seconds(process_nanoseconds_now() - start_ns_); }

double StageStopwatch::wall_seconds() const {
    return to_seconds(nanoseconds_now<bc::steady_clock>() - wall_start_ns_);
}

}  // namespace nuvo::app
