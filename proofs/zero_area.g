# [numerics: triple product] minor_error() in src/geometry/triangle_mesh.cpp: p - q of two products
# of two differences; one of them over its computed magnitude. The subtraction is relative to itself.
n = 4;  # constant, step -1: n u (|p| + |q|)
u = 1b-53;

true = (1 + e1) * (1 + e2) / (1 + e3);
# The sum of magnitudes, the sum with what underflows, the subtraction; the product is exact.
bound = n * u * (1 + e4) * (1 + e5) * (1 + e6);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53
  ->
  1 - true - bound <= 0 /\
  true - 1 - bound <= 0 }
