// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_LANES_H_
#undef NUVO_RENDER_FAST_LANES_H_
#else
#define NUVO_RENDER_FAST_LANES_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

// A fixed number of numbers as one value, in as many registers as the instruction set needs: the
// kernels are written once for 16 rays or 8 octants, whatever the width of a register.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <typename T, std::size_t N>
struct LaneShape {
    static constexpr std::size_t kPart = HWY_MIN(N, HWY_LANES(T));  // lanes of a register
    static constexpr std::size_t kParts = N / kPart;
    using Tag = hn::FixedTag<T, kPart>;
    using Vector = hn::Vec<Tag>;
    using Mask = hn::Mask<Tag>;
};

/// N truth values, in the form in which comparisons of T give them.
template <typename T, std::size_t N>
struct LaneMask : LaneShape<T, N> {
    using Shape = LaneShape<T, N>;
    using Tag = typename Shape::Tag;
    typename Shape::Mask part[Shape::kParts];

    /// Bit i is lane i.
    HWY_INLINE std::uint32_t bits() const {
        std::uint32_t all = 0;
        for (std::size_t i = 0; i < Shape::kParts; ++i) {
            std::uint64_t word = 0;  // its first bytes; the targets are little-endian
            hn::StoreMaskBits(Tag(), part[i], reinterpret_cast<std::uint8_t*>(&word));
            all |= (static_cast<std::uint32_t>(word) &
                    static_cast<std::uint32_t>((1U << Shape::kPart) - 1))
                   << (i * Shape::kPart);
        }
        return all;
    }
    static HWY_INLINE LaneMask from_bits(std::uint32_t bits) {
        LaneMask m;
        for (std::size_t i = 0; i < Shape::kParts; ++i) {
            const std::uint64_t word = bits >> (i * Shape::kPart);
            m.part[i] = hn::LoadMaskBits(Tag(), reinterpret_cast<const std::uint8_t*>(&word));
        }
        return m;
    }
    HWY_INLINE bool any() const {
        bool found = false;
        for (std::size_t i = 0; i < Shape::kParts; ++i) found |= !hn::AllFalse(Tag(), part[i]);
        return found;
    }

    friend HWY_INLINE LaneMask operator&(LaneMask a, const LaneMask& b) {
        for (std::size_t i = 0; i < Shape::kParts; ++i) a.part[i] = hn::And(a.part[i], b.part[i]);
        return a;
    }
    friend HWY_INLINE LaneMask operator|(LaneMask a, const LaneMask& b) {
        for (std::size_t i = 0; i < Shape::kParts; ++i) a.part[i] = hn::Or(a.part[i], b.part[i]);
        return a;
    }
    friend HWY_INLINE LaneMask operator~(LaneMask a) {
        for (std::size_t i = 0; i < Shape::kParts; ++i) a.part[i] = hn::Not(a.part[i]);
        return a;
    }
    /// a and not b.
    friend HWY_INLINE LaneMask without(LaneMask a, const LaneMask& b) {
        for (std::size_t i = 0; i < Shape::kParts; ++i)
            a.part[i] = hn::AndNot(b.part[i], a.part[i]);
        return a;
    }
};

/// N numbers.
template <typename T, std::size_t N>
struct Lanes : LaneShape<T, N> {
    using Shape = LaneShape<T, N>;
    using Tag = typename Shape::Tag;
    using Mask = LaneMask<T, N>;
    typename Shape::Vector part[Shape::kParts];

    HWY_INLINE Lanes() = default;
    /// The same number in each lane.
    HWY_INLINE Lanes(T value) {  // NOLINT(google-explicit-constructor): reads like arithmetic
        for (std::size_t i = 0; i < Shape::kParts; ++i) part[i] = hn::Set(Tag(), value);
    }
    /// Of numbers without sign these take and give the bits.
    HWY_INLINE Lanes(std::uint32_t value) requires(std::is_same_v<T, std::int32_t>)  // NOLINT
        : Lanes(static_cast<T>(value)) {}
    static HWY_INLINE Lanes
    load(const std::uint32_t* from) requires(std::is_same_v<T, std::int32_t>) {
        return load(reinterpret_cast<const T*>(from));
    }
    HWY_INLINE void store(std::uint32_t* to) const requires(std::is_same_v<T, std::int32_t>) {
        store(reinterpret_cast<T*>(to));
    }
    HWY_INLINE void store(std::uint32_t* to, const Mask& mask) const
        requires(std::is_same_v<T, std::int32_t>) {
        store(reinterpret_cast<T*>(to), mask);
    }
    /// `from` need not be aligned.
    static HWY_INLINE Lanes load(const T* from) {
        Lanes v;
        for (std::size_t i = 0; i < Shape::kParts; ++i)
            v.part[i] = hn::LoadU(Tag(), from + i * Shape::kPart);
        return v;
    }
    /// 0 in the other lanes. All N numbers must be readable: SSE4 reads them, and its MaskedLoad
    /// would ask for an aligned address.
    static HWY_INLINE Lanes load(const T* from, const Mask& mask) {
        Lanes v;
        for (std::size_t i = 0; i < Shape::kParts; ++i) {
#if HWY_TARGET == HWY_SSE4
            const auto all = hn::LoadU(Tag(), from + i * Shape::kPart);
            v.part[i] = hn::IfThenElseZero(mask.part[i], all);
#else
            v.part[i] = hn::MaskedLoad(mask.part[i], Tag(), from + i * Shape::kPart);
#endif
        }
        return v;
    }
    /// From numbers of 8 bits.
    static HWY_INLINE Lanes
    from_bytes(const std::int8_t* from) requires(std::is_same_v<T, std::int32_t>) {
        Lanes v;
        for (std::size_t i = 0; i < Shape::kParts; ++i)
            v.part[i] = hn::PromoteTo(Tag(), hn::LoadU(hn::FixedTag<std::int8_t, Shape::kPart>(),
                                                       from + i * Shape::kPart));
        return v;
    }
    /// From 16-bit numbers.
    static HWY_INLINE Lanes
    from_shorts(const std::uint16_t* from) requires(std::is_same_v<T, float>) {
        using Narrow = hn::FixedTag<std::uint16_t, Shape::kPart>;
        using Wide = hn::FixedTag<std::int32_t, Shape::kPart>;
        Lanes v;
        for (std::size_t i = 0; i < Shape::kParts; ++i)
            v.part[i] = hn::ConvertTo(
                Tag(), hn::PromoteTo(Wide(), hn::LoadU(Narrow(), from + i * Shape::kPart)));
        return v;
    }
    /// from[0], from[1], from[2], from[3], from[0] ...
    static HWY_INLINE Lanes load_repeated(const T* from) requires(sizeof(T) == 4) {
        Lanes v;
        for (std::size_t i = 0; i < Shape::kParts; ++i) {
#if HWY_TARGET == HWY_SCALAR
            v.part[i] = hn::Set(Tag(), from[i % 4]);
#else
            v.part[i] = hn::LoadDup128(Tag(), from);
#endif
        }
        return v;
    }
    HWY_INLINE void store(T* to) const {
        for (std::size_t i = 0; i < Shape::kParts; ++i)
            hn::StoreU(part[i], Tag(), to + i * Shape::kPart);
    }
    /// Only the lanes of `mask` are written.
    HWY_INLINE void store(T* to, const Mask& mask) const {
        for (std::size_t i = 0; i < Shape::kParts; ++i)
            hn::BlendedStore(part[i], mask.part[i], Tag(), to + i * Shape::kPart);
    }
    /// from[0] in even lanes, from[1] in odd ones.
    static HWY_INLINE Lanes
    pairs(const std::uint32_t* from) requires(std::is_same_v<T, std::int32_t>) {
        Lanes v;
        if constexpr (Shape::kPart == 1) {
            for (std::size_t i = 0; i < Shape::kParts; ++i)
                v.part[i] = hn::Set(Tag(), static_cast<std::int32_t>(from[i % 2]));
        } else {
            using Pair = hn::FixedTag<std::uint64_t, HWY_MAX(Shape::kPart / 2, 1)>;
            std::uint64_t both;
            std::memcpy(&both, from, sizeof both);
            for (std::size_t i = 0; i < Shape::kParts; ++i)
                v.part[i] = hn::BitCast(Tag(), hn::Set(Pair(), both));
        }
        return v;
    }
    /// Lane i is lane index[i] modulo N of this.
    HWY_INLINE Lanes permuted(const Lanes<std::int32_t, N>& index) const requires(sizeof(T) == 4) {
        Lanes v;
        if constexpr (Shape::kParts == 1) {
            const auto wrapped =
                HWY_TARGET == HWY_AVX3 && !HWY_IS_DEBUG_BUILD
                    ? index.part[0]  // as the instruction does
                    : (index & Lanes<std::int32_t, N>(std::int32_t{N - 1})).part[0];
            v.part[0] = hn::TableLookupLanes(part[0], hn::IndicesFromVec(Tag(), wrapped));
        } else {
            alignas(64) T values[N];
            store(values);
            v = gather(values, index & Lanes<std::int32_t, N>(std::int32_t{N - 1}));
        }
        return v;
    }
    /// The lanes of `mask` side by side; returns their number. Up to N lanes are written.
    HWY_INLINE std::size_t compress_store(T* to, const Mask& mask) const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < Shape::kParts; ++i) {
            hn::StoreU(hn::Compress(part[i], mask.part[i]), Tag(), to + count);
            count += hn::CountTrue(Tag(), mask.part[i]);
        }
        return count;
    }
    HWY_INLINE std::size_t compress_store(std::uint32_t* to, const Mask& mask) const
        requires(std::is_same_v<T, std::int32_t>) {
        return compress_store(reinterpret_cast<T*>(to), mask);
    }
    /// base[index[lane]]; indices of lanes that are not wanted must be valid, too.
    static HWY_INLINE Lanes gather(const T* base,
                                   const Lanes<std::int32_t, N>& index) requires(sizeof(T) == 4) {
        Lanes v;
        for (std::size_t i = 0; i < Shape::kParts; ++i)
            v.part[i] = hn::GatherIndex(Tag(), base, index.part[i]);
        return v;
    }

#define NUVO_LANES_UNARY(name, function)                                                     \
    friend HWY_INLINE Lanes name(Lanes a) {                                                  \
        for (std::size_t i = 0; i < Shape::kParts; ++i) a.part[i] = hn::function(a.part[i]); \
        return a;                                                                            \
    }
    NUVO_LANES_UNARY(operator-, Neg)
    NUVO_LANES_UNARY(abs, Abs)
    NUVO_LANES_UNARY(sqrt, Sqrt)
    NUVO_LANES_UNARY(floor, Floor)
#undef NUVO_LANES_UNARY
#define NUVO_LANES_BINARY(name, function)                   \
    friend HWY_INLINE Lanes name(Lanes a, const Lanes& b) { \
        for (std::size_t i = 0; i < Shape::kParts; ++i)     \
            a.part[i] = hn::function(a.part[i], b.part[i]); \
        return a;                                           \
    }
    NUVO_LANES_BINARY(operator+, Add)
    NUVO_LANES_BINARY(operator-, Sub)
    NUVO_LANES_BINARY(operator*, Mul)
    NUVO_LANES_BINARY(operator/, Div)
    NUVO_LANES_BINARY(operator&, And)
    NUVO_LANES_BINARY(operator|, Or)
    NUVO_LANES_BINARY(operator>>, Shr)
    NUVO_LANES_BINARY(min, Min)
    NUVO_LANES_BINARY(max, Max)
#undef NUVO_LANES_BINARY
#define NUVO_LANES_COMPARE(op, function)                                 \
    friend HWY_INLINE Mask operator op(const Lanes& a, const Lanes& b) { \
        Mask m;                                                          \
        for (std::size_t i = 0; i < Shape::kParts; ++i)                  \
            m.part[i] = hn::function(a.part[i], b.part[i]);              \
        return m;                                                        \
    }
    NUVO_LANES_COMPARE(<, Lt)
    NUVO_LANES_COMPARE(<=, Le)
    NUVO_LANES_COMPARE(>, Gt)
    NUVO_LANES_COMPARE(>=, Ge)
    NUVO_LANES_COMPARE(==, Eq)
    NUVO_LANES_COMPARE(!=, Ne)
#undef NUVO_LANES_COMPARE
    /// a * b + c, with one rounding or two.
    friend HWY_INLINE Lanes mul_add(Lanes a, const Lanes& b, const Lanes& c) {
        for (std::size_t i = 0; i < Shape::kParts; ++i)
            a.part[i] = hn::MulAdd(a.part[i], b.part[i], c.part[i]);
        return a;
    }
    /// c - a * b, with one rounding or two.
    friend HWY_INLINE Lanes neg_mul_add(Lanes a, const Lanes& b, const Lanes& c) {
        for (std::size_t i = 0; i < Shape::kParts; ++i)
            a.part[i] = hn::NegMulAdd(a.part[i], b.part[i], c.part[i]);
        return a;
    }
    /// a where the mask is set, else b.
    friend HWY_INLINE Lanes select(const Mask& mask, Lanes a, const Lanes& b) {
        for (std::size_t i = 0; i < Shape::kParts; ++i)
            a.part[i] = hn::IfThenElse(mask.part[i], a.part[i], b.part[i]);
        return a;
    }
};

/// A mask of the lanes of one type for those of another.
template <typename To, typename From, std::size_t N>
HWY_INLINE LaneMask<To, N> mask_for(const LaneMask<From, N>& mask) requires(sizeof(To) ==
                                                                            sizeof(From)) {
    LaneMask<To, N> out;
    for (std::size_t i = 0; i < LaneShape<To, N>::kParts; ++i)
        out.part[i] = hn::RebindMask(typename LaneShape<To, N>::Tag(), mask.part[i]);
    return out;
}

/// to[4 i] = a[i], to[4 i + 1] = b[i], to[4 i + 2] = c[i], to[4 i + 3] = d[i].
template <typename T, std::size_t N>
HWY_INLINE void store_by_fours(const Lanes<T, N>& a, const Lanes<T, N>& b, const Lanes<T, N>& c,
                               const Lanes<T, N>& d, T* to) {
    using Shape = LaneShape<T, N>;
    for (std::size_t i = 0; i < Shape::kParts; ++i)
        hn::StoreInterleaved4(a.part[i], b.part[i], c.part[i], d.part[i], typename Shape::Tag(),
                              to + 4 * i * Shape::kPart);
}

using Floats = Lanes<float, 16>;  ///< one number for each of 16 rays
using RayMask = LaneMask<float, 16>;
using Ints = Lanes<std::int32_t, 16>;
using OctantFloats = Lanes<float, 8>;  ///< one number for each of 8 octants
using Doubles = Lanes<double, 16>;     ///< Floats' lanes

/// Doubles of one register rounded to the nearest float, beyond floats infinite. Of these the
/// portable targets (EMU128 of clang, SCALAR of g++ 12) would make the largest float, which is no
/// bound.
template <typename Tag, typename Vector>
HWY_INLINE auto to_floats(Tag tag, const Vector& v) {
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
    constexpr std::size_t kLanes = hn::MaxLanes(Tag());
    double from[kLanes];
    float to[kLanes];
    hn::StoreU(v, hn::Rebind<double, Tag>(), from);
    for (std::size_t i = 0; i < kLanes; ++i) to[i] = static_cast<float>(from[i]);
    return hn::LoadU(tag, to);
#else
    return hn::DemoteTo(tag, v);
#endif
}
/// Rounded to the nearest floats.
template <std::size_t N>
HWY_INLINE Lanes<float, N> floats_from(const Lanes<double, N>& v) {
    using Shape = LaneShape<float, N>;
    Lanes<float, N> out;
    for (std::size_t i = 0; i < Shape::kParts; ++i) {
        if constexpr (Shape::kParts == LaneShape<double, N>::kParts) {
            out.part[i] = to_floats(typename Shape::Tag(), v.part[i]);
#if HWY_TARGET != HWY_SCALAR
        } else {
            const hn::Half<typename Shape::Tag> half;
            out.part[i] = hn::Combine(typename Shape::Tag(), to_floats(half, v.part[2 * i + 1]),
                                      to_floats(half, v.part[2 * i]));
#endif
        }
    }
    return out;
}
template <std::size_t N>
HWY_INLINE Lanes<double, N> doubles_from(const Lanes<float, N>& v) {
    using Shape = LaneShape<float, N>;
    using Tag = typename LaneShape<double, N>::Tag;
    Lanes<double, N> out;
    for (std::size_t i = 0; i < Shape::kParts; ++i) {
        if constexpr (Shape::kParts == LaneShape<double, N>::kParts) {
            out.part[i] = hn::PromoteTo(Tag(), v.part[i]);
#if HWY_TARGET != HWY_SCALAR
        } else {
            const hn::Half<typename Shape::Tag> half;
            out.part[2 * i] = hn::PromoteTo(Tag(), hn::LowerHalf(half, v.part[i]));
            out.part[2 * i + 1] = hn::PromoteTo(Tag(), hn::UpperHalf(half, v.part[i]));
#endif
        }
    }
    return out;
}

/// Without their fractions.
HWY_INLINE Ints integers_from(const Floats& v) {
    Ints out;
    for (std::size_t i = 0; i < Floats::Shape::kParts; ++i)
        out.part[i] = hn::ConvertTo(Ints::Tag(), v.part[i]);
    return out;
}

/// At least 1 / sqrt(v), and at most 2^-9 more of it; v >= 0.
template <std::size_t N>
HWY_INLINE Lanes<float, N> above_inverse_sqrt(Lanes<float, N> v) {
    const Lanes<float, N> slack(1 + 0x1p-10F);
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
    return slack / sqrt(v);
#else
    for (std::size_t i = 0; i < LaneShape<float, N>::kParts; ++i)
        v.part[i] = hn::ApproximateReciprocalSqrt(v.part[i]);
    return v * slack;  // the least accurate set is within 1.5 * 2^-12
#endif
}

/// The bits of floats as integers, and back.
template <std::size_t N>
HWY_INLINE Lanes<std::int32_t, N> bits_of(const Lanes<float, N>& v) {
    using Shape = LaneShape<std::int32_t, N>;
    Lanes<std::int32_t, N> out;
    for (std::size_t i = 0; i < Shape::kParts; ++i)
        out.part[i] = hn::BitCast(typename Shape::Tag(), v.part[i]);
    return out;
}
template <std::size_t N>
HWY_INLINE Lanes<float, N> floats_of(const Lanes<std::int32_t, N>& v) {
    using Shape = LaneShape<float, N>;
    Lanes<float, N> out;
    for (std::size_t i = 0; i < Shape::kParts; ++i)
        out.part[i] = hn::BitCast(typename Shape::Tag(), v.part[i]);
    return out;
}
template <int kBits, std::size_t N>
HWY_INLINE Lanes<std::int32_t, N> shift_left(Lanes<std::int32_t, N> v) {
    for (std::size_t i = 0; i < LaneShape<std::int32_t, N>::kParts; ++i)
        v.part[i] = hn::ShiftLeft<kBits>(v.part[i]);
    return v;
}
/// Two to exponents of normal numbers.
template <std::size_t N>
HWY_INLINE Lanes<float, N> powers_of_two(const Lanes<std::int32_t, N>& exponents) {
    return floats_of(shift_left<23>(exponents + Lanes<std::int32_t, N>(127)));
}
/// With copies of the sign.
template <int kBits, std::size_t N>
HWY_INLINE Lanes<std::int32_t, N> shift_right(Lanes<std::int32_t, N> v) {
    for (std::size_t i = 0; i < LaneShape<std::int32_t, N>::kParts; ++i)
        v.part[i] = hn::ShiftRight<kBits>(v.part[i]);
    return v;
}
HWY_INLINE Floats floats_from(const Ints& v) {
    Floats out;
    for (std::size_t i = 0; i < Floats::Shape::kParts; ++i)
        out.part[i] = hn::ConvertTo(Floats::Tag(), v.part[i]);
    return out;
}

/// The lowest and the highest lane.
HWY_INLINE float lowest(const Floats& v) {
    auto all = v.part[0];
    for (std::size_t i = 1; i < Floats::Shape::kParts; ++i) all = hn::Min(all, v.part[i]);
    return hn::GetLane(hn::MinOfLanes(Floats::Tag(), all));
}
HWY_INLINE float highest(const Floats& v) {
    auto all = v.part[0];
    for (std::size_t i = 1; i < Floats::Shape::kParts; ++i) all = hn::Max(all, v.part[i]);
    return hn::GetLane(hn::MaxOfLanes(Floats::Tag(), all));
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_LANES_H_
