# [numerics: shadow rays alone] may_meet() in src/render/fast/tile/segment_box.h: a quotient
# (face - o) / d, in units of the computed one.
n = 8;  # constant, step -1: n u |t|. Five are needed
u = 1b-53;

# The difference and the quotient, against the tail of d.
true = (1 + e1) / (1 + e2) * (1 + e3);
# The product and the sum with what underflows; the last difference or sum.
low = (1 - n * u * (1 + e4) * (1 + e5)) * (1 + e6);
high = (1 + n * u * (1 + e7) * (1 + e8)) * (1 + e9);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53
  ->
  low - true <= 0 /\
  true - high <= 0 }
