# [numerics: parallel projections] CameraRays in src/render/fast/tile/camera_rays.h: how far the exact
# rays of a parallel projection start beside anchor + X right + Y down, as coefficients of the
# picture's middle, of its depth and of the half picture.
n = 8;  # constant, step -1: gamma(n)
u = 1b-53;
gamma = n * u / (1 - n * u);

# RayGenerator: middle + right s + up s', two sums; the anchor: middle - forward depth, a product and
# a difference. What the exact ray has along forward is the very depth.
off_middle = (1 + a1) * (1 + a2) - (1 + b1);
off_depth = (1 + b1) * (1 + b2) - 1;
# s = (2 x / width - 1) half, at t = 2 x / width - 1, then times right, and the sums; the step to the
# next pixel is right (2 half / width), and X of these are t half. (t + 1) (1 + c1) - 1 is t + (t + 1) c1.
off_right = t * ((1 + c2) * (1 + c3) * (1 + c4) * (1 + a1) * (1 + a2) - (1 + c5) * (1 + c6)) +
    (t + 1) * c1 * ((1 + c2) * (1 + c3) * (1 + c4) * (1 + a1) * (1 + a2));
# gamma's quotient and its product with a sum of three terms that are rounded before; the whole
# picture is twice its half.
bound = gamma * (1 + d1) * (1 + d2) * (1 + d3) * (1 + d4) * (1 + d5) * (1 + d6) * (1 + d7);
bound_right = 2 * (1 + c5) * (1 + c6) * bound;

{ t in [-1, 1] /\ |a1| <= 1b-53 /\ |a2| <= 1b-53 /\ |b1| <= 1b-53 /\ |b2| <= 1b-53 /\ |c1| <= 1b-53 /\
  |c2| <= 1b-53 /\ |c3| <= 1b-53 /\ |c4| <= 1b-53 /\ |c5| <= 1b-53 /\ |c6| <= 1b-53 /\ |d1| <= 1b-53 /\
  |d2| <= 1b-53 /\ |d3| <= 1b-53 /\ |d4| <= 1b-53 /\ |d5| <= 1b-53 /\ |d6| <= 1b-53 /\ |d7| <= 1b-53
  ->
  off_middle - bound <= 0 /\
  - off_middle - bound <= 0 /\
  off_depth - bound <= 0 /\
  - off_depth - bound <= 0 /\
  off_right - bound_right <= 0 /\
  - off_right - bound_right <= 0 }
