// For libFuzzer: build/fuzz/tests/fuzz_options
#include <cstddef>

#include "bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    nuvo::fuzz::take_options({reinterpret_cast<const char*>(data), size});
    return 0;
}
