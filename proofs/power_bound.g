# [numerics: discriminant bound] detail::power_error_bound() in include/nuvo/geometry/predicates.h:
# f.f - R^2, the power of the origin, as coefficients of f.f and R^2.
n = 8;  # constant, step -1: gamma(n)
u = 1b-53;
gamma = n * u / (1 - n * u);

# f twice, product, two sums, and the subtraction.
error_f = (1 + e1) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5) * (1 + e6) - 1;
# R R and the subtraction.
error_r = (1 + e7) * (1 + e8) - 1;
# gamma's quotient and the product with f.f + R^2; the computed sum itself.
bound_f = gamma * (1 + e9) * (1 + e10) * (1 + e11) * (1 + e12) * (1 + e13) * (1 + e14) *
    (1 + e15) * (1 + e16);
bound_r = gamma * (1 + e17) * (1 + e18) * (1 + e19) * (1 + e20);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\ |e11| <= 1b-53 /\ |e12| <= 1b-53 /\
  |e13| <= 1b-53 /\ |e14| <= 1b-53 /\ |e15| <= 1b-53 /\ |e16| <= 1b-53 /\ |e17| <= 1b-53 /\ |e18| <= 1b-53 /\
  |e19| <= 1b-53 /\ |e20| <= 1b-53
  ->
  error_f - bound_f <= 0 /\
  - error_f - bound_f <= 0 /\
  error_r - bound_r <= 0 /\
  - error_r - bound_r <= 0 }
