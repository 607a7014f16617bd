# [numerics: crowds] HullPlanes::error() and surely_missed() in src/render/hull_planes.h: one term
# out_i p_i; out is the plane's normal as it stands, the true p is p (1 + e).
n = 8;  # constant, step -1: gamma(n). Five are needed
m = 4;  # constant, step -1: kDown = 1 - gamma(m) lowers a quotient
u = 1b-53;
gamma = n * u / (1 - n * u);
down_by = m * u / (1 - m * u);

computed = (1 + e1) * (1 + e2) * (1 + e3);
true = (1 + e4);
# gamma's quotient, a product, two sums, a product, the last sum.
bound = gamma * (1 + e5) * (1 + e6) * (1 + e7) * (1 + e8) * (1 + e9) * (1 + e10);
# room / ((speed - unsure) kDown): a difference, a product, a quotient; kDown itself.
down = (1 - down_by * (1 + e11)) * (1 + e12);
late = (1 + e13) / ((1 + e14) * (1 + e15) * down);
# -room kDown / (-speed + unsure).
early = (1 + e16) * (1 + e17) * down / (1 + e18);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\ |e11| <= 1b-53 /\ |e12| <= 1b-53 /\
  |e13| <= 1b-53 /\ |e14| <= 1b-53 /\ |e15| <= 1b-53 /\ |e16| <= 1b-53 /\ |e17| <= 1b-53 /\ |e18| <= 1b-53
  ->
  computed - true - bound <= 0 /\
  true - computed - bound <= 0 /\
  1 - late <= 0 /\
  early - 1 <= 0 }
