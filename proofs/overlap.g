# [numerics: ranges] overlaps() in src/geometry/overlap.cpp: the coefficients of a squared distance
# and of the squared radius, and of the box's half widths. Above the normal range the sum with what
# underflows rounds nothing.
n = 8;  # constant, step -1: 1 + gamma(n) of the squared radius
m = 4;  # constant, step -1: gamma(m) of the box's size
u = 1b-53;
gamma = n * u / (1 - n * u);
gamma_box = m * u / (1 - m * u);

# A distance is rounded twice in its square; the product and two sums. The radius' square; the sum
# 1 + gamma, and its product.
least = (1 + e1) * (1 + e2) * float<ieee_64,ne>(1 + gamma) - (1 + e3) * (1 + e4) * (1 + e5) *
    (1 + e6) * (1 + e7);
most = (1 + e8) * (1 + e9) * (1 + e10) * (1 + e11) * (1 + e12) - (1 + e13) * (1 + e14) *
    float<ieee_64,ne>(1 - gamma);
# The centre, up to the size: a sum, halved; the half width: a difference.
off = (1 + e15) - (1 + e16);
slack = gamma_box * (1 + e17) * (1 + e18) * (1 + e19);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\ |e11| <= 1b-53 /\ |e12| <= 1b-53 /\
  |e13| <= 1b-53 /\ |e14| <= 1b-53 /\ |e15| <= 1b-53 /\ |e16| <= 1b-53 /\ |e17| <= 1b-53 /\ |e18| <= 1b-53 /\
  |e19| <= 1b-53
  ->
  - least <= 0 /\
  - most <= 0 /\
  off - slack <= 0 /\
  - off - slack <= 0 }
