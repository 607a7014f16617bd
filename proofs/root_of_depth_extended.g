# [numerics: depth bound] root_part() in src/geometry/predicates_quadratic.cpp: the error of
# sqrt(a depth), depth known within x, |x| < 1/4, and a within y, relatively.
#
# sqrt(1 + x) - 1 = x / (sqrt(1 + x) + 1): the coefficients of |x|, |y| and of the roundings.
# The same of long double (x87).
c = 9;  # constant, step -1: c / 16 of depth_error / depth
n = 4;  # constant, step -1: gamma(n)
u = 1b-64;
gamma = n * u / (1 - n * u);

# Two roots and their product.
value = (1 + e1) * (1 + e2) * (1 + e3);
of_x = 1 / (sqrt(1 + x) + 1) * (1 + y);
of_y = 1 / (sqrt(1 + y) + 1) * (1 + x);
# A quotient, a product, two sums, a product.
bound_x = c / 16 * (1 + e4) * (1 + e5) * (1 + e6) * (1 + e7) * (1 + e8) * value;
bound_y = (1 + e9) * (1 + e10) * (1 + e11) * value;
bound = gamma * (1 + e12) * (1 + e13) * (1 + e14) * (1 + e15) * value;

{ |e1| <= 1b-64 /\ |e2| <= 1b-64 /\ |e3| <= 1b-64 /\ |e4| <= 1b-64 /\ |e5| <= 1b-64 /\ |e6| <= 1b-64 /\
  |e7| <= 1b-64 /\ |e8| <= 1b-64 /\ |e9| <= 1b-64 /\ |e10| <= 1b-64 /\ |e11| <= 1b-64 /\ |e12| <= 1b-64 /\
  |e13| <= 1b-64 /\ |e14| <= 1b-64 /\ |e15| <= 1b-64 /\
  |x| <= 1b-2 /\
  |y| <= 1b-40
  ->
  of_x - bound_x <= 0 /\
  1 / (sqrt(1 + y) + 1) - bound_y <= 0 /\
  value - 1 - bound <= 0 /\
  1 - value - bound <= 0 }
