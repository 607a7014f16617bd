#include "nuvo/math/exact.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace nuvo {
namespace {

__extension__ typedef unsigned __int128 DoubleLimb;
constexpr std::int64_t kLimbBits = 64;

/// Beyond these shifts the smaller summand cannot reach the larger one's last bit.
constexpr std::int64_t kNegligibleShift = 2 * std::numeric_limits<double>::digits;
constexpr std::int64_t kLargestShift = 4 * std::numeric_limits<double>::max_exponent;

}  // namespace

WideDouble::WideDouble(double significand, std::int64_t exponent) {
    int shift = 0;
    significand_ = std::frexp(significand, &shift);
    exponent_ = significand_ == 0 ? 0 : exponent + shift;
}

double WideDouble::rounded() const {
    return std::ldexp(significand_,
                      static_cast<int>(std::clamp(exponent_, -kLargestShift, kLargestShift)));
}

WideDouble operator+(const WideDouble& a, const WideDouble& b) {
    if (a.significand_ == 0) return b;
    if (b.significand_ == 0) return a;
    const WideDouble& large = a.exponent_ < b.exponent_ ? b : a;
    const WideDouble& small = a.exponent_ < b.exponent_ ? a : b;
    const std::int64_t shift = std::min(large.exponent_ - small.exponent_, kNegligibleShift);
    return WideDouble(large.significand_ + std::ldexp(small.significand_, -static_cast<int>(shift)),
                      large.exponent_);
}

WideDouble operator*(const WideDouble& a, const WideDouble& b) {
    return WideDouble(a.significand_ * b.significand_, a.exponent_ + b.exponent_);
}

WideDouble operator/(const WideDouble& a, const WideDouble& b) {
    return WideDouble(a.significand_ / b.significand_, a.exponent_ - b.exponent_);
}

WideDouble sqrt(const WideDouble& a) {
    const std::int64_t odd = a.exponent_ & 1;
    return WideDouble(std::sqrt(odd != 0 ? 2 * a.significand_ : a.significand_),
                      (a.exponent_ - odd) / 2);
}

Exact::Exact(double value) {
    constexpr int kFractionBits = std::numeric_limits<double>::digits - 1;
    constexpr int kSmallestExponent = std::numeric_limits<double>::min_exponent - 1 - kFractionBits;
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(value);
    const std::uint64_t fraction = bits & ((std::uint64_t{1} << kFractionBits) - 1);
    const int biased = static_cast<int>(bits >> kFractionBits) & 0x7ff;
    const std::uint64_t mantissa =
        biased == 0 ? fraction : fraction | (std::uint64_t{1} << kFractionBits);
    const int exponent = kSmallestExponent + (biased == 0 ? 0 : biased - 1);
    if (mantissa == 0) return;
    negative_ = (bits >> (kLimbBits - 1)) != 0;
    exponent_ = exponent >> 6;
    const int shift = exponent & 63;
    small_[0] = mantissa << shift;
    small_[1] = shift == 0 ? 0 : mantissa >> (kLimbBits - shift);
    size_ = 2;
    trim();
}

Exact& Exact::operator=(const Exact& other) {
    if (this != &other) assign(other);
    return *this;
}

Exact& Exact::operator=(Exact&& other) noexcept {
    if (this != &other) take(other);
    return *this;
}

void Exact::assign(const Exact& other) {
    size_ = other.size_;
    exponent_ = other.exponent_;
    negative_ = other.negative_;
    large_ = other.large_;
    if (large_.empty()) std::copy_n(other.small_.data(), size_, small_.data());
}

void Exact::take(Exact& other) noexcept {
    size_ = std::exchange(other.size_, 0);
    exponent_ = other.exponent_;
    negative_ = other.negative_;
    large_ = std::move(other.large_);
    other.large_.clear();
    if (large_.empty()) std::copy_n(other.small_.data(), size_, small_.data());
}

Exact::Limb* Exact::allocate(std::size_t size) {
    size_ = size;
    if (size > kInline) large_.resize(size);
    return limbs();
}

void Exact::trim() {
    Limb* const x = limbs();
    while (size_ > 0 && x[size_ - 1] == 0) --size_;
    std::size_t zeros = 0;
    while (zeros < size_ && x[zeros] == 0) ++zeros;
    if (zeros > 0) {
        std::copy(x + zeros, x + size_, x);
        size_ -= zeros;
        exponent_ += static_cast<std::int64_t>(zeros);
    }
}

Exact Exact::operator-() const {
    Exact result = *this;
    result.negative_ = !negative_;
    return result;
}

WideDouble Exact::approximate() const {
    if (size_ == 0) return WideDouble();
    const Limb* const x = limbs();
    const int zeros = std::countl_zero(x[size_ - 1]);
    Limb top = x[size_ - 1] << zeros;
    if (zeros > 0 && size_ > 1) top |= x[size_ - 2] >> (kLimbBits - zeros);
    const double magnitude = static_cast<double>(top);
    return WideDouble(negative_ ? -magnitude : magnitude,
                      (exponent_ + static_cast<std::int64_t>(size_) - 1) * kLimbBits - zeros);
}

Exact Exact::sum(const Exact& a, const Exact& b, bool negate_b) {
    if (b.size_ == 0) return a;
    if (a.size_ == 0) return negate_b ? -b : b;
    Exact result;
    result.exponent_ = std::min(a.exponent_, b.exponent_);
    result.negative_ = a.negative_;
    const auto a_low = static_cast<std::size_t>(a.exponent_ - result.exponent_);
    const auto b_low = static_cast<std::size_t>(b.exponent_ - result.exponent_);
    const std::size_t size = std::max(a_low + a.size_, b_low + b.size_) + 1;
    Limb* const r = result.allocate(size);
    std::fill_n(r, a_low, Limb{0});
    std::copy_n(a.limbs(), a.size_, r + a_low);
    std::fill(r + a_low + a.size_, r + size, Limb{0});
    const Limb* const y = b.limbs();
    Limb carry = 0;
    if (a.negative_ == (b.negative_ != negate_b)) {
        for (std::size_t i = b_low; i < size && (carry != 0 || i < b_low + b.size_); ++i) {
            const DoubleLimb s =
                DoubleLimb{r[i]} + (i < b_low + b.size_ ? y[i - b_low] : 0) + carry;
            r[i] = static_cast<Limb>(s);
            carry = static_cast<Limb>(s >> kLimbBits);
        }
    } else {
        for (std::size_t i = b_low; i < size && (carry != 0 || i < b_low + b.size_); ++i) {
            const DoubleLimb s =
                DoubleLimb{r[i]} - (i < b_low + b.size_ ? y[i - b_low] : 0) - carry;
            r[i] = static_cast<Limb>(s);
            carry = static_cast<Limb>(s >> kLimbBits) & 1;
        }
        if (carry != 0) {  // |b| > |a|: what stands there is 2^n - (|b| - |a|)
            for (std::size_t i = 0; i < size; ++i) {
                r[i] = ~r[i] + carry;
                carry = carry != 0 && r[i] == 0 ? 1 : 0;
            }
            result.negative_ = !result.negative_;
        }
    }
    result.trim();
    return result;
}

Exact Exact::product(const Exact& a, const Exact& b) {
    Exact result;
    if (a.size_ == 0 || b.size_ == 0) return result;
    result.exponent_ = a.exponent_ + b.exponent_;
    result.negative_ = a.negative_ != b.negative_;
    Limb* const r = result.allocate(a.size_ + b.size_);
    std::fill_n(r, a.size_ + b.size_, Limb{0});
    const Limb* const x = a.limbs();
    const Limb* const y = b.limbs();
    for (std::size_t i = 0; i < a.size_; ++i) {
        Limb carry = 0;
        for (std::size_t j = 0; j < b.size_; ++j) {
            const DoubleLimb s = DoubleLimb{x[i]} * y[j] + r[i + j] + carry;
            r[i + j] = static_cast<Limb>(s);
            carry = static_cast<Limb>(s >> kLimbBits);
        }
        r[i + b.size_] = carry;
    }
    result.trim();
    return result;
}

}  // namespace nuvo
