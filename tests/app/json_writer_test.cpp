#include "nuvo/app/json_writer.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace nuvo::app {
namespace {

nlohmann::json parsed(const JsonWriter& json) { return nlohmann::json::parse(json.text()); }

TEST(JsonWriter, AnotherLibraryReadsWhatWasWritten) {
    JsonWriter json;
    json.begin_object();
    json.member("empty list", std::vector<double>{});
    json.member("numbers", std::vector<double>{0.1, -0.0, 1e300, DBL_TRUE_MIN});
    json.key("objects");
    json.begin_array();
    for (int i = 0; i < 2; ++i) {
        json.begin_object();
        json.member("i", i);
        json.end_object();
    }
    json.begin_object();
    json.end_object();
    json.null();
    json.value(true);
    json.end_array();
    json.member("large", std::numeric_limits<std::uint64_t>::max());
    json.member("text", "a \"b\" \\c\\ \n\t\x01 \x7f \xc3\xa9");
    json.end_object();
    const nlohmann::json expected = {
        {"empty list", nlohmann::json::array()},
        {"numbers", {0.1, -0.0, 1e300, DBL_TRUE_MIN}},
        {"objects", {{{"i", 0}}, {{"i", 1}}, nlohmann::json::object(), nullptr, true}},
        {"large", std::numeric_limits<std::uint64_t>::max()},
        {"text", "a \"b\" \\c\\ \n\t\x01 \x7f \xc3\xa9"}};
    EXPECT_EQ(parsed(json), expected) << json.text();
}

TEST(JsonWriter, WhatIsNotFiniteIsNull) {
    for (const double number :
         {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::quiet_NaN()}) {
        JsonWriter json;
        json.value(number);
        EXPECT_EQ(json.text(), "null\n");
    }
}

TEST(JsonWriter, EveryDoubleReadsBackToTheBit) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    JsonWriter json;
    std::vector<double> numbers;
    while (numbers.size() < 10'000) {
        const std::uint64_t bits = random();
        double number = 0;
        std::memcpy(&number, &bits, sizeof number);
        if (std::isfinite(number)) numbers.push_back(number);
    }
    json.value(numbers);
    EXPECT_EQ(parsed(json).get<std::vector<double>>(), numbers);
}

TEST(JsonWriter, InvalidUtf8IsReplacedAndValidKept) {
    const std::string replaced = "\xef\xbf\xbd";
    EXPECT_EQ(valid_utf8("a\xffz"), "a" + replaced + "z");
    for (const char* valid : {"", "plain", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x98\x80",
                              "\xef\xbf\xbf", "\xf4\x8f\xbf\xbf", "\xed\x9f\xbf"})
        EXPECT_EQ(valid_utf8(valid), valid);
    // Overlong forms, a surrogate, beyond U+10FFFF, a lone continuation, a cut sequence.
    for (const std::string invalid : {"\xc0\xaf", "\xe0\x80\xaf", "\xf0\x80\x80\xaf",
                                      "\xed\xa0\x80", "\xf4\x90\x80\x80", "\x80", "\xe2\x82"}) {
        std::string expected;
        for (std::size_t i = 0; i < invalid.size(); ++i) expected += replaced;
        EXPECT_EQ(valid_utf8(invalid), expected);
    }
}

TEST(JsonWriter, RandomBytesAlwaysMakeADocument) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (int i = 0; i < 2000; ++i) {
        std::string bytes(random() % 12, '\0');
        for (char& c : bytes) c = static_cast<char>(random());
        JsonWriter json;
        json.value(bytes);
        EXPECT_TRUE(nlohmann::json::accept(json.text()));
    }
}

}  // namespace
}  // namespace nuvo::app
