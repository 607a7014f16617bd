# [numerics: local frame] LocalRay::prepare_slabs() in src/render/fast/rays/local_ray.cpp: a plane
# x = c at s = (c - o) / d, computed as fl(c i + a), in units of (|c| + |o|) |i|.
n = 8;  # constant, step -1: kSlabRoundings. Five are needed, as a is computed in double
m = 10;  # constant, step -1: RayBlock's, with a and its slack in float
u = 1b-24;
# i: d rounded to float, a quotient, conversion of it. The coefficient of c: the product and the sum.
i = (1 + e1) * (1 + e2);
of_c = i * (1 + e3) * (1 + e4) - 1;
# a = -o i: its conversion and the sum.
of_o = i * (1 + e5) * (1 + e6) - 1;
# The slack is within a: conversion and the sum take from it, too, as does its own i.
bound = n * u * (1 + e7) * (1 + e8) / (1 + e9) * (1 + e10);
# In float: the slack's sum and its product, the sum with a.
in_float = m * u * (1 + e11) * (1 + e12) * (1 + e13) * (1 + e14) * (1 + e15) *
    (1 + e16) / (1 + e17) * (1 + e18);
of_a = i * (1 + e19) * (1 + e20) * (1 + e21) - 1;

{ |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24 /\ |e5| <= 1b-24 /\ |e6| <= 1b-24 /\
  |e7| <= 1b-24 /\ |e8| <= 1b-24 /\ |e9| <= 1b-24 /\ |e10| <= 1b-24 /\ |e11| <= 1b-24 /\ |e12| <= 1b-24 /\
  |e13| <= 1b-24 /\ |e14| <= 1b-24 /\ |e15| <= 1b-24 /\ |e16| <= 1b-24 /\ |e17| <= 1b-24 /\ |e18| <= 1b-24 /\
  |e19| <= 1b-24 /\ |e20| <= 1b-24 /\ |e21| <= 1b-24
  ->
  of_c - bound <= 0 /\
  - of_c - bound <= 0 /\
  of_o - bound <= 0 /\
  of_a - in_float <= 0 /\
  - of_a - in_float <= 0 }
