#include "gunzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <vector>

#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

namespace {

constexpr int kGzipOnly = 16 + MAX_WBITS;  // as inflateInit2 has it
constexpr std::size_t kBlock = 1 << 18;

class Inflater {
  public:
    Inflater() {
        if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
    }
    ~Inflater() { inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    z_stream& stream() { return stream_; }

  private:
    z_stream stream_{};
};

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

Text gunzip(std::string_view bytes, const std::string& file, std::size_t limit) {
    Inflater inflater;
    z_stream& stream = inflater.stream();
    Text text;
    std::vector<char> block(kBlock);
    std::size_t next = 0;
    for (;;) {
        if (stream.avail_in == 0) {
            const std::size_t size =
                std::min<std::size_t>(bytes.size() - next, std::numeric_limits<uInt>::max());
            // zlib reads from it only.
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + next));
            stream.avail_in = static_cast<uInt>(size);
            next += size;
        }
        stream.next_out = reinterpret_cast<Bytef*>(block.data());
        stream.avail_out = static_cast<uInt>(block.size());
        const int status = inflate(&stream, Z_NO_FLUSH);
        if (status == Z_MEM_ERROR) throw std::bad_alloc();
        if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
            throw Error(file + ": packed by gzip, but damaged");
        const std::size_t size = block.size() - stream.avail_out;
        if (size > limit - text.size())
            throw Error(file + ": unpacks to more bytes than allowed (limit " +
                        std::to_string(limit) + ")");
        text.insert(text.end(), block.data(), block.data() + size);
        if (status == Z_STREAM_END) {
            const std::string_view rest = bytes.substr(next - stream.avail_in);
            if (!is_gzip(rest)) return text;  // gzip itself ignores what follows, too
            inflateReset(&stream);
        } else if (size == 0 && stream.avail_in == 0 && next == bytes.size()) {
            throw Error(file + ": packed by gzip, but cut off");
        }
    }
}

}  // namespace nuvo::x3d
