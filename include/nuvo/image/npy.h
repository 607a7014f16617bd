#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "nuvo/image/file_writer.h"

/// NumPy's array files (.npy, format versions 1 to 3). [NEP 1]
namespace nuvo::image {

/// A file that is no array: what() is the reason, without the file's name.
class NpyError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

static_assert(std::endian::native == std::endian::little, "arrays are written as they are held");

/// How NumPy writes the type in a file's header: '<f8', '<u4', '|u1'.
template <typename T>
requires std::integral<T> || std::floating_point<T> std::string npy_type() {
    const char kind = std::is_same_v<T, bool>       ? 'b'
                      : std::is_floating_point_v<T> ? 'f'
                      : std::is_unsigned_v<T>       ? 'u'
                                                    : 'i';
    return std::string("'") + (sizeof(T) == 1 ? '|' : '<') + kind + std::to_string(sizeof(T)) + "'";
}

/// What stands before the bytes of an array: `type` as Python writes it, so "'<f8'" or
/// "[('t', '<f8'), ...]" for an array of records; by rows (C order); filled up to 64 bytes.
std::string npy_header(std::string_view type, std::span<const std::size_t> shape);

/// Writes an array whole or not at all; `values` holds as many as `shape` says, by rows. Throws
/// WriteError.
template <typename T>
void write_npy(const std::filesystem::path& path, std::span<const T> values,
               std::span<const std::size_t> shape) {
    FileWriter writer(path);
    writer.write(npy_header(npy_type<T>(), shape));
    writer.write({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
    writer.commit();
}

/// An array as a file holds it.
struct NpyArray {
    std::string type;  ///< as Python writes it
    bool by_columns = false;
    std::vector<std::size_t> shape;
    std::string_view data;  ///< within the bytes that were read
};

/// Whether a file begins as arrays do.
bool is_npy(std::string_view bytes);

/// Reads the header and checks that the data are as long as it says; `item_bytes` of types of
/// records are not known: theirs are not checked. Throws NpyError.
NpyArray parse_npy(std::string_view bytes);

/// The values of an array of float64, float32 or integers of up to 32 bits, of either byte order,
/// by rows. Throws NpyError for any other type.
std::vector<double> npy_doubles(const NpyArray& array);

}  // namespace nuvo::image
