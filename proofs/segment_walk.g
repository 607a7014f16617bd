# [numerics: shadow rays alone] SegmentWalk in src/render/fast/shadow/segment_walk.h: the planes of
# voxels, moved outwards, and the quotients. The true origin is o (1 + e).
n = 16;  # constant, step -1: n u |t| of a quotient. Ten are needed
m = 4;  # constant, step -1: m u |o| of the origin
u = 1b-53;

# A plane x = p with |p| <= 2 |o|, in units of |o|: it moves by more than the origin is off. The
# slack: a sum with what underflows; then the moved plane is rounded.
moved = - m * u * (1 + e1) + (p + 4 * u) * e_plane;

# One with |p| >= 2 |o|, in units of |p|: what the rounded plane and the origin are off by,
# relative to p - o. (The move itself is outwards.)
off = ((1 + 4 * u) * e_plane + o * e_origin) / (1 - o);

# The quotient: the tail of d and, times the frame's scale, nothing; two for d in all; reciprocal,
# difference, product. Its slack: a sum with what underflows, then a difference or a sum.
true = (1 + e2) * (1 + e3) * (1 + off) / (1 + e4) * (1 + e5) * (1 + e6);
low = (1 - n * u * (1 + e7)) * (1 + e8);
high = (1 + n * u * (1 + e9)) * (1 + e10);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\
  |p| <= 2 /\
  |o| <= 1b-1 /\
  |e_plane| <= 1b-53 /\
  |e_origin| <= 1b-53
  ->
  moved <= -1b-53 /\
  low - true <= 0 /\
  true - high <= 0 }
