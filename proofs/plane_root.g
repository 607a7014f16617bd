# [numerics: plane root] try_hit() in src/geometry/predicates_triangle.cpp, find_roots() in
# src/render/fast/rays/triangle_roots.cpp; the quotients of rounded_hit() in
# src/geometry/predicates_quadratic.cpp.
#
# Both parts of the quotient t are known within a share of 2^-44 = root_tolerance(): then the true
# one lies between the computed low and high.
share = 7;  # constant, step 1: share / 16 of root_tolerance()
tolerance = 1b-44;
# within(): the error is compared with a rounded product.
x = share / 16 * tolerance * s1 * (1 + e1);
y = share / 16 * tolerance * s2 * (1 + e2);
# t, in units of the quotient of the computed parts: a division, and for long double a conversion.
t = (1 + e3) * (1 + e4);
low = t * (1 - tolerance) * (1 + e5);
high = t * (1 + tolerance) * (1 + e6);
true = (1 + x) / (1 + y);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |s1| <= 1 /\
  |s2| <= 1
  ->
  low - true <= 0 /\
  true - high <= 0 }
