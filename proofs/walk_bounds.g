# [numerics: the walk] slab_entry(), Entry::before() and ExactWalk::lower_bound_of() in
# include/nuvo/octree/walk.h.
before = 8;  # constant, step -1: t (1 - before u). Three are needed
slack = 8;  # constant, step -1: exit + slack u (entry + |exit|). Three are needed
exit = 8;  # constant, step -1: the exit's lower bound, exit u (base + |t|). Six are needed
u = 1b-53;

# t = (face - o) / d: a difference and a quotient.
true_entry = 1 / (1 + e1) * (1 + e2);
earlier = (1 - before * u) * (1 + e3);

# The ray meets the box: the true entry is at most the true exit; where they are one t, the computed
# entry is not beyond the computed exit and the slack: a sum, a product by a power of two, a sum.
passes = (1 + e4) * (1 + e5) - ((1 + e6) * (1 + e7) + slack * u * (2 - 4 * u) * (1 + e8)) *
    (1 + e9);

# The coefficients of base and of |t|, t of either sign: base + t, base + |t|, two differences.
low_base = ((1 + e10) - exit * u * (1 + e11)) * (1 + e12) * (1 + e13);
low_ahead = ((1 + e14) - exit * u * (1 + e15)) * (1 + e16) * (1 + e17);
low_behind = ((1 + e18) + exit * u * (1 + e19)) * (1 + e20) * (1 + e21);
ahead = 1 / (1 + e22) * (1 + e23);
behind = 1 / (1 + e24) * (1 + e25);

{ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |e3| <= 1b-53 /\ |e4| <= 1b-53 /\ |e5| <= 1b-53 /\ |e6| <= 1b-53 /\
  |e7| <= 1b-53 /\ |e8| <= 1b-53 /\ |e9| <= 1b-53 /\ |e10| <= 1b-53 /\ |e11| <= 1b-53 /\ |e12| <= 1b-53 /\
  |e13| <= 1b-53 /\ |e14| <= 1b-53 /\ |e15| <= 1b-53 /\ |e16| <= 1b-53 /\ |e17| <= 1b-53 /\ |e18| <= 1b-53 /\
  |e19| <= 1b-53 /\ |e20| <= 1b-53 /\ |e21| <= 1b-53 /\ |e22| <= 1b-53 /\ |e23| <= 1b-53 /\ |e24| <= 1b-53 /\
  |e25| <= 1b-53
  ->
  earlier - true_entry <= 0 /\
  passes <= 0 /\
  low_base - 1 <= 0 /\
  low_ahead - ahead <= 0 /\
  behind - low_behind <= 0 }
