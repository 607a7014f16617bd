# [numerics: edge bound] detail::edge_error_bound() and detail::line_test() in
# include/nuvo/geometry/predicates.h.
#
# One of the six terms d_i C_j B_k of an edge function, in units of |d| m^2, where |direction| <= |d|
# and the computed |C|, |B| <= m are largest components (so all three are within 1 here). A rounded
# difference or direction x is x (1 + e) in truth. Six such errors are six times this bound.
n = 9;  # constant, step -1: 6 gamma(n)
k = 16;  # constant, step -1: k 2^-1074 (m + 1) of what underflows
u = 1b-53;
gamma = n * u / (1 - n * u);

# Two products, the subtraction of the cross product and two sums.
computed = (1 + e1) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5);
# The tail of d, and the differences C and B.
true = (1 + e6) * (1 + e7) * (1 + e8);
# gamma's quotient, 6 gamma, m m, what is added for underflow, d_norm, their product, the last sum.
bound = gamma * (1 + e9) * (1 + e10) * (1 + e11) * (1 + e12) * (1 + e13) * (1 + e14) * (1 + e15);

# Underflow, in units of 2^-1074 (m + 1): each product of one component of d and one of C loses 1/2,
# times |B| <= m; each product with B, or of the squares, loses 1/2. Two products and their
# difference, three products and two sums; what the bound's own products lose.
lost = (6 * m + 3) / 2 * (1 + e16) * (1 + e17) * (1 + e18) * (1 + e19) + 3 / 2;
kept = k * (m + 1) * (1 + e20) * (1 + e21) * (1 + e22) - (m + 1) / 2;

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\ |e11| <= 1b-53 /\ |e12| <= 1b-53 /\
  |e13| <= 1b-53 /\ |e14| <= 1b-53 /\ |e15| <= 1b-53 /\ |e16| <= 1b-53 /\ |e17| <= 1b-53 /\ |e18| <= 1b-53 /\
  |e19| <= 1b-53 /\ |e20| <= 1b-53 /\ |e21| <= 1b-53 /\ |e22| <= 1b-53 /\
  m in [0,1b900]
  ->
  computed - true - bound <= 0 /\
  true - computed - bound <= 0 /\
  (lost - kept) / (m + 1) <= 0 }
