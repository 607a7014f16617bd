# [numerics: voxels seen by a macro tile] Affine in src/render/fast/primary/affine_lanes.h, in
# units of T, and the bound of 1 / t in frustum.h. The sum of an affine function's terms is within T.
n = 16;  # constant, step -1: kRoundings. The rest of the last one is for double arithmetic
m = 4;  # constant, step -1: 1 + m u of 1 / z
u = 1b-24;
# Middle and coefficient rounded, the product and up to three sums; of the half widths the same
# without a constant's own rounding. The two, each within T, are added or subtracted.
at = (1 + e1) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5) * (1 + e6) * (1 + e7) - 1;
spread = (1 + e8) * (1 + e9) * (1 + e10) * (1 + e11) * (1 + e12) * (1 + e13) - 1;
error = at + spread + 2 * last * (1 + e14) * (1 + e15) * (1 + e16) * (1 + e17) * (1 + e18) *
    (1 + e19) * (1 + e20) * (1 + e21) * (1 + e22) * (1 + e23) * (1 + e24) * (1 + e25) * (1 + e26);
# Some 2^-50 T of the double arithmetic.
bound = n * u - 1b-40;

# near was rounded once, which its bound contains; the quotient and its product.
up = (1 + e27) * (1 + m * u) * (1 + e28);

{ |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24 /\ |e5| <= 1b-24 /\ |e6| <= 1b-24 /\
  |e7| <= 1b-24 /\ |e8| <= 1b-24 /\ |e9| <= 1b-24 /\ |e10| <= 1b-24 /\ |e11| <= 1b-24 /\ |e12| <= 1b-24 /\
  |e13| <= 1b-24 /\ |e14| <= 1b-24 /\ |e15| <= 1b-24 /\ |e16| <= 1b-24 /\ |e17| <= 1b-24 /\ |e18| <= 1b-24 /\
  |e19| <= 1b-24 /\ |e20| <= 1b-24 /\ |e21| <= 1b-24 /\ |e22| <= 1b-24 /\ |e23| <= 1b-24 /\ |e24| <= 1b-24 /\
  |e25| <= 1b-24 /\ |e26| <= 1b-24 /\ |e27| <= 1b-24 /\ |e28| <= 1b-24 /\
  |last| <= 1b-24
  ->
  error - bound <= 0 /\
  1 - up <= 0 }
