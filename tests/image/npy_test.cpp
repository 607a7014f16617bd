#include "nuvo/image/npy.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

namespace nuvo::image {
namespace {

using namespace std::string_literals;

// What numpy.save of NumPy 1.24 wrote: header of 118 bytes, filled up with blanks.
std::string file(std::string dictionary, const std::string& data) {
    dictionary.resize(117, ' ');
    return "\x93NUMPY\x01\x00v\x00"s + dictionary + "\n" + data;
}
const std::string kTwoByThree = file("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }",
                                     "\0\0\0\0\0\0\xf0?\0\0\0\0\0\0\0@\0\0\0\0\0\0\x08@"
                                     "\0\0\0\0\0\0\x10@\0\0\0\0\0\0\x14@\0\0\0\0\0\0\x18@"s);

std::string written(const auto&... arguments) {
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / "nuvo_npy_test.npy";
    write_npy(path, arguments...);
    std::ifstream stream(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    std::filesystem::remove(path);
    return bytes;
}

std::string error_of(const std::string& bytes) {
    try {
        npy_doubles(parse_npy(bytes));
    } catch (const NpyError& error) {
        return error.what();
    }
    return {};
}

TEST(Npy, WritesTheBytesThatNumPyWrites) {
    const std::vector<double> values{1, 2, 3, 4, 5, 6};
    const std::vector<std::size_t> shape{2, 3};
    EXPECT_EQ(written(std::span<const double>(values), std::span<const std::size_t>(shape)),
              kTwoByThree);
    const std::vector<std::uint8_t> bytes{1};
    const std::vector<std::size_t> one{1};
    EXPECT_EQ(written(std::span<const std::uint8_t>(bytes), std::span<const std::size_t>(one)),
              file("{'descr': '|u1', 'fortran_order': False, 'shape': (1,), }", "\x01"));
    EXPECT_EQ(npy_type<std::int32_t>(), "'<i4'");
    EXPECT_EQ(npy_type<std::uint32_t>(), "'<u4'");
    EXPECT_EQ(npy_type<bool>(), "'|b1'");
    const std::vector<std::size_t> two{2};
    EXPECT_EQ(npy_header("[('hit', '|u1'), ('t', '<f8')]", two),
              file("{'descr': [('hit', '|u1'), ('t', '<f8')], 'fortran_order': False, "
                   "'shape': (2,), }",
                   ""));
}

TEST(Npy, EveryHeaderEndsAtAMultipleOf64) {
    for (std::size_t rows = 1; rows < 1'000'000'000'000; rows *= 10) {
        const std::vector<std::size_t> shape{rows, rows, rows};
        const std::string header = npy_header("'<f8'", shape);
        EXPECT_EQ(header.size() % 64, 0u);
        EXPECT_EQ(header.back(), '\n');
    }
}

TEST(Npy, ReadsWhatNumPyWrites) {
    const NpyArray array = parse_npy(kTwoByThree);
    EXPECT_EQ(array.type, "'<f8'");
    EXPECT_EQ(array.shape, (std::vector<std::size_t>{2, 3}));
    EXPECT_EQ(npy_doubles(array), (std::vector<double>{1, 2, 3, 4, 5, 6}));
    // By columns, of the other byte order, in 2 bytes.
    EXPECT_EQ(
        npy_doubles(parse_npy(file("{'descr': '>i2', 'fortran_order': True, 'shape': (2, 3), }",
                                   "\0\x01\0\x04\0\x02\0\x05\0\x03\0\x06"s))),
        (std::vector<double>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(npy_doubles(parse_npy(file(
                  "{'descr': '<f4', 'fortran_order': False, 'shape': (1,), }", "\0\0\xc0\xbf"s))),
              (std::vector<double>{-1.5}));
    // No sides: one value. 7.5
    EXPECT_EQ(npy_doubles(parse_npy(file("{'descr': '<f8', 'fortran_order': False, 'shape': (), }",
                                         "\0\0\0\0\0\0\x1e@"s))),
              (std::vector<double>{7.5}));
    // Version 2: four bytes of length; keys in any order, other blanks and quotes.
    const std::string dictionary = "{ \"shape\" : ( 1 , ),'fortran_order':False,'descr':'|i1'}\n";
    EXPECT_EQ(npy_doubles(parse_npy("\x93NUMPY\x02\x00"s + static_cast<char>(dictionary.size()) +
                                    "\0\0\0"s + dictionary + "\xff")),
              (std::vector<double>{-1}));
}

TEST(Npy, WhatIsNoArrayIsRefusedInWords) {
    const auto is_refused = [](const std::string& bytes, const std::string& part) {
        EXPECT_NE(error_of(bytes).find(part), std::string::npos) << part << ": " << error_of(bytes);
    };
    is_refused("0 0 0 0 0 1", "does not begin");
    is_refused("\x93NUMPY\x04\x00v\x00"s, "version 4");
    is_refused(kTwoByThree.substr(0, 60), "within the header");
    is_refused(kTwoByThree.substr(0, kTwoByThree.size() - 1), "47 bytes of data, not 6 times 8");
    is_refused(kTwoByThree + "x", "49 bytes of data");
    is_refused(file("{'descr': '<c8', 'fortran_order': False, 'shape': (1,), }", "12345678"),
               "'<c8'");
    is_refused(file("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }", "12345678"),
               "'|O'");
    is_refused(
        file("{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296), }", ""),
        "too large");
    is_refused(file("{'descr': '<f8', 'fortran_order': 1, 'shape': (1,), }", "12345678"),
               "fortran_order");
    is_refused(file("{'descr': '<f8', 'fortran_order': False, 'shape': (-1,), }", "12345678"),
               "shape");
    is_refused(file("{'fortran_order': False, 'shape': (1,), }", "12345678"), "descr");
}

TEST(Npy, NoBytesDoHarm) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (int i = 0; i < 20'000; ++i) {
        std::string bytes = kTwoByThree;
        for (unsigned n = random() % 4; n > 0; --n)
            bytes[6 + random() % 66] = static_cast<char>(random() % 256);
        if (random() % 4 == 0) bytes.resize(random() % bytes.size());
        try {
            const NpyArray array = parse_npy(bytes);
            EXPECT_LE(npy_doubles(array).size(), 48u);
        } catch (const NpyError&) {
        }
    }
}

}  // namespace
}  // namespace nuvo::image
