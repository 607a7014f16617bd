#include "nuvo/image/png.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <exception>
#include <functional>
#include <new>
#include <string_view>

#include "nuvo/image/file_writer.h"

namespace nuvo::image {
namespace {

using Sink = std::function<void(std::string_view)>;

/// What must outlive the jumps by which libpng reports errors: no exception passes through it.
struct Transfer {
    const Sink& sink;
    std::exception_ptr failure = nullptr;  // of the sink
    std::string reason = {};               // libpng's own
};

extern "C" void transfer_bytes(png_structp png, png_bytep bytes, std::size_t size) {
    auto& transfer = *static_cast<Transfer*>(png_get_io_ptr(png));
    try {
        transfer.sink({reinterpret_cast<const char*>(bytes), size});
        return;
    } catch (...) {
        transfer.failure = std::current_exception();
    }
    png_error(png, "the bytes were not taken");
}

extern "C" void nothing_to_flush(png_structp) {}

extern "C" [[noreturn]] void note_error(png_structp png, png_const_charp reason) {
    auto& transfer = *static_cast<Transfer*>(png_get_error_ptr(png));
    try {
        transfer.reason = reason;
    } catch (const std::bad_alloc&) {
        transfer.failure = std::current_exception();
    }
    png_longjmp(png, 1);
}

extern "C" void ignore_warning(png_structp, png_const_charp) {}

/// Only what has no destructor lives between setjmp and the jump back. False: it failed.
bool encode(png_structp png, png_infop info, const Image& image) {
    // Half of level 6's time, for a tenth more bytes.
    constexpr int kLevel = 3;
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_compression_level(png, kLevel);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB | PNG_FILTER_UP);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width()),
                 static_cast<png_uint_32>(image.height()), 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    static_assert(sizeof(Rgb8) == 3);  // a row of pixels is a row of the format
    for (int y = 0; y < image.height(); ++y)
        png_write_row(png, reinterpret_cast<png_const_bytep>(&image.at(0, y)));
    png_write_end(png, info);
    return true;
}

/// Throws what the sink threw; else WriteError, named by `name`.
void encode_into(const Sink& sink, const Image& image, const std::string& name) {
    Transfer transfer{sink};
    png_structp png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &transfer, note_error, ignore_warning);
    if (png == nullptr) throw std::bad_alloc();
    png_infop info = png_create_info_struct(png);
    bool written = false;
    if (info != nullptr) {
        png_set_write_fn(png, &transfer, transfer_bytes, nothing_to_flush);
        png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        written = encode(png, info, image);
    }
    png_destroy_write_struct(&png, &info);
    if (written) return;
    if (transfer.failure) std::rethrow_exception(transfer.failure);
    if (transfer.reason.empty()) throw std::bad_alloc();
    throw WriteError(name + ": cannot write: " + transfer.reason);
}

}  // namespace

std::string encode_png(const Image& image) {
    std::string bytes;
    encode_into([&bytes](std::string_view part) { bytes += part; }, image, "picture");
    return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
    constexpr std::size_t kChunkBytes = 1 << 20;
    FileWriter writer(path);
    std::string chunk;
    encode_into(
        [&](std::string_view part) {
            chunk += part;
            if (chunk.size() < kChunkBytes) return;
            writer.write(chunk);
            chunk.clear();
        },
        image, path.string());
    writer.write(chunk);
    writer.commit();
}

}  // namespace nuvo::image
