#pragma once

namespace nuvo::generator {

/// Sine and cosine of `angle` radians (0 to 10,000) rounded to float. Made of operations that IEEE
/// 754 rounds correctly, so that every platform writes the same digits.
float float_sine(float angle);
float float_cosine(float angle);

}  // namespace nuvo::generator
