#pragma once

#include <cstdint>

namespace nuvo::app {

/// Processor time the process spent in the program and in the kernel, and the time on the wall.
struct ProcessTimes {
    double user_seconds = 0;  ///< moves in steps of kUserClockStepSeconds
    double system_seconds = 0;
    double wall_seconds = 0;
};

/// The step of process_user_cpu_clock on Linux.
inline constexpr double kUserClockStepSeconds = 0.01;

/// The clock the thesis times with (process_user_cpu_clock): started once, read once, around all
/// repetitions. [thesis 5.7.1]
class ProcessStopwatch {
  public:
    ProcessStopwatch();
    ProcessTimes elapsed() const;

  private:
    std::int64_t user_ns_;
    std::int64_t system_ns_;
    std::int64_t wall_ns_;
};

/// A fine clock for one stage: processor time of all threads, in nanoseconds, which other programs
/// on the machine disturb least.
class StageStopwatch {
  public:
    StageStopwatch();
    double seconds() const;
    double wall_seconds() const;

  private:
    std::int64_t start_ns_;
    std::int64_t wall_start_ns_;
};

}  // namespace nuvo::app
