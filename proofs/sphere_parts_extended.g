# [numerics: depth bound] rounded_quadratic() of a sphere in src/geometry/predicates_sphere.cpp:
# a = d.d relative to the computed one, and b = f.d, in units of |f| |d|.
# The same of long double (x87).
n = 7;  # constant, step -1: b_error = gamma(n) f_norm length
m = 6;  # constant, step -1: a_relative = gamma(m)
u = 1b-64;
gamma = n * u / (1 - n * u);
gamma_a = m * u / (1 - m * u);

# f, d's tail, a product and two sums.
error_b = (1 + e1) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5) - 1;
# gamma's quotient and two products; roots of f.f and of d.d, each of five roundings.
bound_b = gamma * (1 + e6) * (1 + e7) * (1 + e8) * sqrt((1 + e9) * (1 + e10) * (1 + e11) *
    (1 + e12) * (1 + e13)) * (1 + e14) * sqrt((1 + e15) * (1 + e16) * (1 + e17) * (1 + e18) *
    (1 + e19)) * (1 + e20);
# The tail twice, a product and two sums.
square = (1 + e21) * (1 + e22) * (1 + e23) * (1 + e24) * (1 + e25);
error_a = 1 / square - 1;
bound_a = gamma_a * (1 + e26);

{ |e1| <= 1b-64 /\ |e2| <= 1b-64 /\ |e3| <= 1b-64 /\ |e4| <= 1b-64 /\ |e5| <= 1b-64 /\ |e6| <= 1b-64 /\
  |e7| <= 1b-64 /\ |e8| <= 1b-64 /\ |e9| <= 1b-64 /\ |e10| <= 1b-64 /\ |e11| <= 1b-64 /\ |e12| <= 1b-64 /\
  |e13| <= 1b-64 /\ |e14| <= 1b-64 /\ |e15| <= 1b-64 /\ |e16| <= 1b-64 /\ |e17| <= 1b-64 /\ |e18| <= 1b-64 /\
  |e19| <= 1b-64 /\ |e20| <= 1b-64 /\ |e21| <= 1b-64 /\ |e22| <= 1b-64 /\ |e23| <= 1b-64 /\ |e24| <= 1b-64 /\
  |e25| <= 1b-64 /\ |e26| <= 1b-64
  ->
  error_b - bound_b <= 0 /\
  - error_b - bound_b <= 0 /\
  error_a - bound_a <= 0 /\
  - error_a - bound_a <= 0 }
