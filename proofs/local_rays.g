# [numerics: local frame] RayBlock::prepare_slabs() in src/render/fast/rays/ray_block.h: a plane
# x = c at s = (c - o) / d, computed as fl(c i + a), in units of (|c| + |o|) |i|.
n = 10;  # constant, step -1: kSlabRoundings
u = 1b-24;
# i: d rounded to float, and a quotient. The coefficient of c: the product and the sum.
i = (1 + e1) * (1 + e2);
of_c = i * (1 + e3) * (1 + e4) - 1;
# a = -o i: its conversion, the sum with the slack, and the walk's.
of_a = i * (1 + e5) * (1 + e6) * (1 + e7) - 1;
# The slack: |o| rounded, its sum and product, with an i of its own, the sum with a and the walk's.
bound = n * u * (1 + e8) * (1 + e9) * (1 + e10) * (1 + e11) * (1 + e12) * (1 + e13) / (1 + e14) *
    (1 + e15);

{ |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24 /\ |e5| <= 1b-24 /\ |e6| <= 1b-24 /\
  |e7| <= 1b-24 /\ |e8| <= 1b-24 /\ |e9| <= 1b-24 /\ |e10| <= 1b-24 /\ |e11| <= 1b-24 /\ |e12| <= 1b-24 /\
  |e13| <= 1b-24 /\ |e14| <= 1b-24 /\ |e15| <= 1b-24
  ->
  of_c - bound <= 0 /\
  - of_c - bound <= 0 /\
  of_a - bound <= 0 /\
  - of_a - bound <= 0 }
