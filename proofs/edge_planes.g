# [numerics: edge planes] sure_sign() in src/geometry/predicates_triangle.cpp: one term n_i v_i over
# its computed magnitude. The true n is n (1 + w e), the true v is v (1 + e).
n = 6;  # constant, step -1: gamma(n)
u = 1b-53;
gamma = n * u / (1 - n * u);

# Exact::approximate(): the upper 64 bits, then rounded to double. In units of u:
w = 1025 / 1024;
bits = fixed<0,dn>(x);
normal = float<ieee_64,ne>(bits);

computed = (1 + e1) * (1 + e2) * (1 + e3);
true = (1 + w * e) * (1 + e4);
# gamma's quotient; a product and two sums; their product and the last sum.
bound = gamma * (1 + e5) * (1 + e6) * (1 + e7) * (1 + e8) * (1 + e9) * (1 + e10);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\
  |e| <= 1b-53 /\
  x in [1b63,1b64]
  ->
  |x -/ normal| <= 1025b-63 /\
  computed - true - bound <= 0 /\
  true - computed - bound <= 0 }
