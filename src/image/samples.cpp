#include "nuvo/image/samples.h"

#include <cstdint>
#include <vector>

namespace nuvo::image {

Image averaged(const Image& samples, int side) {
    Image mean(samples.width() / side, samples.height() / side);
    const auto count = static_cast<std::uint32_t>(side) * static_cast<std::uint32_t>(side);
    struct Sum {
        std::uint32_t r = 0, g = 0, b = 0;
    };
    const auto rounded = [count](std::uint32_t sum) {
        return static_cast<std::uint8_t>((2 * sum + count) / (2 * count));
    };
    std::vector<Sum> row;
    for (int y = 0; y < mean.height(); ++y) {
        row.assign(static_cast<std::size_t>(mean.width()), Sum());
        for (int j = 0; j < side; ++j) {
            const Rgb8* sample = &samples.at(0, y * side + j);
            for (Sum& sum : row)
                for (int i = 0; i < side; ++i, ++sample) {
                    sum.r += sample->r;
                    sum.g += sample->g;
                    sum.b += sample->b;
                }
        }
        for (int x = 0; x < mean.width(); ++x) {
            const Sum& sum = row[static_cast<std::size_t>(x)];
            mean.at(x, y) = {rounded(sum.r), rounded(sum.g), rounded(sum.b)};
        }
    }
    return mean;
}

}  // namespace nuvo::image
