#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "nuvo/math/progress.h"

namespace nuvo::app {

/// What a Meter knows of a work at one moment.
struct MeterReading {
    std::string title;      ///< "tracing"
    const char* unit = "";  ///< of `done` and `total`
    std::uint64_t done = 0;
    std::uint64_t total = 0;  ///< 0: unknown
    double seconds = 0;       ///< that the work has taken so far
    const char* part = "";    ///< of what the work belongs to one of several: "repetition"
    std::size_t number = 0;   ///< of the part, from 1 on; 0: there are no parts
    std::size_t parts = 0;
    double part_seconds = 0;    ///< that this part has taken so far
    double before_seconds = 0;  ///< that all parts before it took
};

/// "repetition 2 of 5: tracing: 42 %, 1.25 million pixels/s, 12 s left": as much of it as is known.
std::string meter_line(const MeterReading& reading);

/// Tells a person on a terminal how far long works are: a line on standard error that begins when
/// the command has taken a second, changes at most ten times a second, and is gone in the end.
/// Where standard error is no terminal there is neither a line nor a thread.
class Meter {
  public:
    /// Not `wanted`: it never tells anything.
    explicit Meter(bool wanted);
    ~Meter();

    /// A work begins; the one before it, if any, is done. Null where nobody looks.
    Progress* begin(const std::string& title);
    /// The works from now on belong to a part of several alike, the first one number 1.
    void begin_part(const char* part, std::size_t number, std::size_t parts);
    /// Before anything else is written to the terminal: no work is on, and the line is gone.
    void end();

  private:
    class Shown;
    std::unique_ptr<Shown> shown_;  // null where nobody looks
};

}  // namespace nuvo::app
