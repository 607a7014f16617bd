# [numerics: triple product] triple_product() in src/geometry/predicates_bounded.h, of long double (x87).
#
# One of the six terms d_i p_j q_k, over its computed magnitude. What a rounded difference or
# direction x stands for is x (1 + e). The errors of six such terms are bounded by their sum.
n = 9;  # constant, step -1: gamma(n)
k = 16;  # constant, step -1: k units (|d|_1 + 1) of what underflows
u = 1b-64;
gamma = n * u / (1 - n * u);

# Two products, the subtraction of the cross product and two sums.
computed = (1 + e1) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5);
# d, p and q.
true = (1 + e6) * (1 + e7) * (1 + e8);
# gamma's quotient; a product, a sum, a product and two sums of magnitudes; their product, last sum.
bound = gamma * (1 + e9) * (1 + e10) * (1 + e11) * (1 + e12) * (1 + e13) * (1 + e14) *
    (1 + e15) * (1 + e16);

# Underflow in units of 2^-1074 (2^-16445), s = |d|_1: two inner products a component lose 1/2 each,
# times |d_i|, and three outer ones 1/2; the same of the bound's products, and one more of gamma's.
lost = s * (1 + e17) * (1 + e18) * (1 + e19) * (1 + e20) + 3 / 2 * (1 + e21) * (1 + e22);
kept = k * (s + 1) * (1 + e23) * (1 + e24) * (1 + e25) - (gamma * (s * (1 + e26) * (1 + e27) *
    (1 + e28) * (1 + e29) + 3 / 2 * (1 + e30) * (1 + e31)) + 1 / 2);

{ |e1| <= 1b-64 /\ |e2| <= 1b-64 /\ |e3| <= 1b-64 /\ |e4| <= 1b-64 /\ |e5| <= 1b-64 /\ |e6| <= 1b-64 /\
  |e7| <= 1b-64 /\ |e8| <= 1b-64 /\ |e9| <= 1b-64 /\ |e10| <= 1b-64 /\ |e11| <= 1b-64 /\ |e12| <= 1b-64 /\
  |e13| <= 1b-64 /\ |e14| <= 1b-64 /\ |e15| <= 1b-64 /\ |e16| <= 1b-64 /\ |e17| <= 1b-64 /\ |e18| <= 1b-64 /\
  |e19| <= 1b-64 /\ |e20| <= 1b-64 /\ |e21| <= 1b-64 /\ |e22| <= 1b-64 /\ |e23| <= 1b-64 /\ |e24| <= 1b-64 /\
  |e25| <= 1b-64 /\ |e26| <= 1b-64 /\ |e27| <= 1b-64 /\ |e28| <= 1b-64 /\ |e29| <= 1b-64 /\ |e30| <= 1b-64 /\
  |e31| <= 1b-64 /\
  s in [0,1b1000]
  ->
  computed - true - bound <= 0 /\
  true - computed - bound <= 0 /\
  (lost - kept) / (s + 1) <= 0 }
