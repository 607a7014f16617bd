# [numerics: discriminant bound] detail::discriminant_error_bound() in
# include/nuvo/geometry/predicates.h.
#
# In units of a = d.d, with |f|^2 = F and R^2: b = k |f|, |k| <= 1 (Cauchy and Schwarz), so that
# b^2 - a c is linear in F and R^2, as are its error and the bound: each coefficient is bounded.
n = 32;  # constant, step -1: gamma(n). 25 are needed; the rest is slack
u = 1b-53;
gamma = n * u / (1 - n * u);

# f, d with its tail, a product and two sums: b is off by beta |f|.
beta = (1 + e1) * (1 + e2) * (1 + e3) * (1 + e4) * (1 + e5) - 1;
# b b and the last subtraction.
twice = (1 + e6) * (1 + e7);
error_bb = k * k * (twice - 1) + (2 * k * beta + beta * beta) * twice;
# a: d twice, product, sums. |f|^2: f twice, product, sums. Then f.f - R^2, a c, last subtraction.
error_f = error_bb - ((1 + e8) * (1 + e9) * (1 + e10) * (1 + e11) * (1 + e12) * (1 + e13) *
    (1 + e14) * (1 + e15) * (1 + e16) * (1 + e17) * (1 + e18) * (1 + e19) * (1 + e20) - 1);
# a, R R, f.f - R^2, a c, last subtraction.
error_r = (1 + e21) * (1 + e22) * (1 + e23) * (1 + e24) * (1 + e25) * (1 + e26) * (1 + e27) *
    (1 + e28) * (1 + e29) - 1;
# gamma's quotient, two products; a; f.f and the sum with R^2.
bound_f = gamma * (1 + e30) * (1 + e31) * (1 + e32) * (1 + e33) * (1 + e34) * (1 + e35) *
    (1 + e36) * (1 + e37) * (1 + e38) * (1 + e39) * (1 + e40) * (1 + e41) * (1 + e42) * (1 + e43);
bound_r = gamma * (1 + e44) * (1 + e45) * (1 + e46) * (1 + e47) * (1 + e48) * (1 + e49) *
    (1 + e50) * (1 + e51) * (1 + e52) * (1 + e53);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\ |e11| <= 1b-53 /\ |e12| <= 1b-53 /\
  |e13| <= 1b-53 /\ |e14| <= 1b-53 /\ |e15| <= 1b-53 /\ |e16| <= 1b-53 /\ |e17| <= 1b-53 /\ |e18| <= 1b-53 /\
  |e19| <= 1b-53 /\ |e20| <= 1b-53 /\ |e21| <= 1b-53 /\ |e22| <= 1b-53 /\ |e23| <= 1b-53 /\ |e24| <= 1b-53 /\
  |e25| <= 1b-53 /\ |e26| <= 1b-53 /\ |e27| <= 1b-53 /\ |e28| <= 1b-53 /\ |e29| <= 1b-53 /\ |e30| <= 1b-53 /\
  |e31| <= 1b-53 /\ |e32| <= 1b-53 /\ |e33| <= 1b-53 /\ |e34| <= 1b-53 /\ |e35| <= 1b-53 /\ |e36| <= 1b-53 /\
  |e37| <= 1b-53 /\ |e38| <= 1b-53 /\ |e39| <= 1b-53 /\ |e40| <= 1b-53 /\ |e41| <= 1b-53 /\ |e42| <= 1b-53 /\
  |e43| <= 1b-53 /\ |e44| <= 1b-53 /\ |e45| <= 1b-53 /\ |e46| <= 1b-53 /\ |e47| <= 1b-53 /\ |e48| <= 1b-53 /\
  |e49| <= 1b-53 /\ |e50| <= 1b-53 /\ |e51| <= 1b-53 /\ |e52| <= 1b-53 /\ |e53| <= 1b-53 /\
  |k| <= 1
  ->
  error_f - bound_f <= 0 /\
  - error_f - bound_f <= 0 /\
  error_r - bound_r <= 0 /\
  - error_r - bound_r <= 0 }
