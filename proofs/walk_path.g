# [numerics: the walk] path_error_bound() in src/octree/walk.cpp, in units of S, the largest
# coordinate of the scene, for an origin outside of the root; inside it is less.
#
# The origin is a point of the ray just before the root, |o| <= 2 S, but for one rounding on each
# axis: the walk follows a parallel ray. |t d| <= 3 S on each axis within the root.
n = 16;  # constant, step -1: n u S. 13 are needed; the rest is slack
u = 1b-53;

moved = 2 * e_origin;
# t = (face - o) / d: a difference and a quotient; its product with d.
way = 3 * ((1 + e1) * (1 + e2) * (1 + e3) - 1);
# The sum o + t d, within the root up to the errors before.
error = moved + way + (1 + 1b-40) * e_sum;
# The product's and the sum's rounding with what underflows.
bound = n * u * (1 + e4) * (1 + e5);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\
  |e_origin| <= 1b-53 /\
  |e_sum| <= 1b-53
  ->
  error - bound <= 0 /\
  - error - bound <= 0 }
