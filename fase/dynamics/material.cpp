/// Combines two materials.
#include "fase/dynamics/material.hpp"

#include <cmath>

namespace fase {

float combined(float a, CombineMode mode_a, float b, CombineMode mode_b) {
    switch (mode_a < mode_b ? mode_b : mode_a) {
        case CombineMode::Average: return (a + b) * 0.5f;
        case CombineMode::GeometricMean: return std::sqrt(a * b);
        case CombineMode::Minimum: return a < b ? a : b;
        case CombineMode::Multiply: return a * b;
        case CombineMode::Maximum: return a > b ? a : b;
    }
    return 0;
}

}  // namespace fase
