# [numerics: crowds] DirectionCells::columns() in src/render/direction_cells.cpp:
# the coefficients of u and of s w in the error of u - s w, with the computed magnitudes.
n = 4;  # constant, step -1: gamma(n)
u = 1b-53;
gamma = n * u / (1 - n * u);

# u: the difference, against the last subtraction.
error_u = (1 + e1) - (1 + e2);
# s w: the product and the last subtraction, against the difference.
error_w = (1 + e3) * (1 + e4) - (1 + e5);
# s w itself, gamma's quotient, the sum of magnitudes, the product, and the sum with what underflows.
bound_u = gamma * (1 + e6) * (1 + e7) * (1 + e8) * (1 + e9);
bound_w = gamma * (1 + e10) * (1 + e11) * (1 + e12) * (1 + e13) * (1 + e14);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\ |e11| <= 1b-53 /\ |e12| <= 1b-53 /\
  |e13| <= 1b-53 /\ |e14| <= 1b-53
  ->
  error_u - bound_u <= 0 /\
  - error_u - bound_u <= 0 /\
  error_w - bound_w <= 0 /\
  - error_w - bound_w <= 0 }
