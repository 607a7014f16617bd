# [numerics: ellipsoids] product() in src/geometry/predicates_quadratic.h, local_radius() and
# component_errors() in predicates_ellipsoid.cpp: one term adj_ij v_j = (p q - r s) v_j over its
# computed magnitudes.
n = 8;  # constant, step -1: gamma(n)
u = 1b-53;
gamma = n * u / (1 - n * u);

# Two roundings of adj, and a product and two sums; against v's own.
computed = (1 + e1) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5);
true = (1 + e6);
# gamma's quotient; a product and a sum of magnitudes, a product, two sums; all three rows; a product
# and the last sum.
bound = gamma * (1 + e7) * (1 + e8) * (1 + e9) * (1 + e10) * (1 + e11) * (1 + e12) *
    (1 + e13) * (1 + e14) * (1 + e15) * (1 + e16);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\ |e11| <= 1b-53 /\ |e12| <= 1b-53 /\
  |e13| <= 1b-53 /\ |e14| <= 1b-53 /\ |e15| <= 1b-53 /\ |e16| <= 1b-53
  ->
  computed - true - bound <= 0 /\
  true - computed - bound <= 0 }
