#pragma once
// Random numbers that are the same on every platform: the standard fixes the engine, not its distributions.

#include "hsdm/types.hh"

#include <cmath>
#include <numbers>
#include <random>

namespace hsdm::support {

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    std::uint64_t bits() { return engine_(); }
    /// In [0, 1), 53 random bits.
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
    /// In [0, n), n > 0; the bias of the remainder is below n / 2^64.
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }
    /// Standard normal, Box-Muller.
    double gauss() {
        const double radius = std::sqrt(-2 * std::log(1 - uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }
    Vec3 gauss3() {
        const double x = gauss(), y = gauss(), z = gauss();
        return {x, y, z};
    }
    /// Even over the unit sphere.
    Vec3 direction() {
        const double z = uniform(-1, 1), angle = uniform(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }

private:
    std::mt19937_64 engine_;
};

} // namespace hsdm::support
