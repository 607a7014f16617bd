# [numerics: ranges] detail::discriminant_error_bound(): a R^2 and b^2 may be as small as 2^-1700.
#
# In units of 2^-1074: b b and a c lose 1/2 each, and so does the bound's last product.
k = 4;  # constant, step -1: k 2^-1074
u = 1b-53;

# The bound without underflow exceeds the error without it; two sums follow.
lost = 1 / 2 * (1 + e1) * (1 + e2) + 1 / 2 * (1 + e3) * (1 + e4) + 1 / 2 * (1 + e5);
kept = k * (1 + e6);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |zero| <= 0
  ->
  lost - kept <= 0 }
