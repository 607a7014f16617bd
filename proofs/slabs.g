# [numerics: crowds] Slabs in src/render/leaf_boxes.h: where a ray crosses the plane of a box's side.
# The bounds of the computed t, in units of it.
n = 6;  # constant, step -1: gamma(n) |t|
u = 1b-53;
gamma = n * u / (1 - n * u);

# t = (difference) (1 / d): difference, the tail of d, reciprocal, product.
true = (1 + e1) * (1 + e2) / (1 + e3) * (1 + e4);
# gamma's quotient, its product, the sum with what underflows, and the last subtraction or sum.
low = (1 - gamma * (1 + e5) * (1 + e6) * (1 + e7)) * (1 + e8);
high = (1 + gamma * (1 + e9) * (1 + e10) * (1 + e11)) * (1 + e12);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\ |e11| <= 1b-53 /\ |e12| <= 1b-53
  ->
  low - true <= 0 /\
  true - high <= 0 }
