#include "meter.h"

#include <gtest/gtest.h>

namespace nuvo::app {
namespace {

TEST(MeterLine, TellsShareRateAndTimeLeft) {
    MeterReading now;
    now.title = "tracing";
    now.unit = "pixels";
    now.done = 500'000;
    now.total = 2'000'000;
    now.seconds = 4;  // a quarter: three quarters take 12
    EXPECT_EQ(meter_line(now), "tracing: 25 %, 125 thousand pixels/s, 12 s left");
    now.done = 2'000'000;
    EXPECT_EQ(meter_line(now), "tracing: 100 %, 500 thousand pixels/s, 0 s left");
    now.seconds = 1;
    EXPECT_EQ(meter_line(now), "tracing: 100 %, 2 million pixels/s, 0 s left");
    now.done = 4;
    EXPECT_EQ(meter_line(now), "tracing: 0 %, 4 pixels/s, 139 h left");
    now.done = 10'000;
    EXPECT_EQ(meter_line(now), "tracing: 0 %, 10 thousand pixels/s, 3 min left");
}

TEST(MeterLine, TellsOnlyWhatIsKnown) {
    MeterReading now;
    now.title = "reading";
    EXPECT_EQ(meter_line(now), "reading");
    now.unit = "bytes";
    now.total = 10;
    now.seconds = 3;
    EXPECT_EQ(meter_line(now), "reading: 0 %");
    now.total = 0;
    now.done = 6000;
    EXPECT_EQ(meter_line(now), "reading: 2 thousand bytes/s");
}

TEST(MeterLine, MoreThanAllIsAll) {
    MeterReading now;
    now.title = "reading";
    now.unit = "shapes";
    now.done = 12;
    now.total = 10;
    now.seconds = 2;
    EXPECT_EQ(meter_line(now), "reading: 100 %, 6 shapes/s, 0 s left");
}

TEST(MeterLine, ForeseesTheEndOfAllParts) {
    MeterReading now;
    now.title = "tracing";
    now.unit = "pixels";
    now.part = "repetition";
    now.number = 1;
    now.parts = 5;
    now.done = 10;
    now.total = 40;
    now.seconds = 2;       // all of it takes 8,
    now.part_seconds = 3;  // and a part 9: 45 in all, of which 3 are over
    EXPECT_EQ(meter_line(now), "repetition 1 of 5: tracing: 25 %, 5 pixels/s, 42 s left");
    now.number = 3;
    now.before_seconds = 20;  // 10 each, and 3 of the third one's are over
    EXPECT_EQ(meter_line(now), "repetition 3 of 5: tracing: 25 %, 5 pixels/s, 27 s left");
    now.done = 0;  // known from the parts before
    EXPECT_EQ(meter_line(now), "repetition 3 of 5: tracing: 0 %, 27 s left");
}

}  // namespace
}  // namespace nuvo::app
