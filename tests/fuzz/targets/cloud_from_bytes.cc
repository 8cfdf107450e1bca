#include "fuzz/targets/cloud_from_bytes.hh"

#include "support/random.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm::fuzz {
namespace {

using support::Random;

constexpr std::size_t most_points = 320;

/// Mostly a small whole or dyadic number, sometimes what coordinates should not be.
double number(FuzzedDataProvider& data) {
    constexpr std::array special{0.0,
                                 -0.0,
                                 1e-300,
                                 5e-324,
                                 1e300,
                                 -1.7e308,
                                 1.0 / 3,
                                 1e17,
                                 std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()};
    switch (data.ConsumeIntegralInRange<int>(0, 15)) {
    case 0:
        return data.ConsumeFloatingPoint<double>();
    case 1:
        return data.PickValueInArray(special);
    case 2:
    case 3:
    case 4:
        return data.ConsumeIntegral<std::int16_t>() / 1024.0;
    default:
        return data.ConsumeIntegral<std::int8_t>() / 16.0;
    }
}

/// In this order on every compiler: braces evaluate from left to right, a call's arguments in any order.
Vec3 vector(FuzzedDataProvider& data) {
    return Vec3{number(data), number(data), number(data)};
}

double power(FuzzedDataProvider& data, int least, int most) {
    return std::ldexp(1, data.ConsumeIntegralInRange<int>(least, most));
}

/// Points with the normals that a perfect scanner would give.
class Cloud {
public:
    explicit Cloud(FuzzedDataProvider& data) : data_(data) {}

    void add_piece() {
        random_ = Random(data_.ConsumeIntegral<std::uint16_t>());
        size_ = data_.ConsumeIntegralInRange<int>(0, 3) == 0 ? power(data_, -12, 8) : 1;
        center_ = data_.ConsumeBool() ? vector(data_) : Vec3(0, 0, 0);
        noise_ = data_.ConsumeBool() ? power(data_, -12, -2) : 0;
        count_ = std::min<std::size_t>(data_.ConsumeIntegralInRange<std::size_t>(1, 160), left());
        switch (data_.ConsumeIntegralInRange<int>(0, 9)) {
        case 0:
            return add_points();
        case 1:
            return add_line();
        case 2:
            return add_lattice();
        case 3:
            return add_plane();
        case 4:
            return add_sphere();
        case 5:
            return add_box();
        case 6:
            return add_cluster();
        case 7:
            return add_sheets();
        case 8:
            return add_cylinder();
        default:
            return add_copies();
        }
    }

    std::size_t left() const { return most_points - positions.size(); }

    std::vector<Vec3> positions, normals;

private:
    void add(const Vec3& p, const Vec3& normal) {
        if (left() == 0) return;
        positions.push_back(center_ + size_ * (noise_ > 0 ? p + noise_ * random_.gauss3() : p));
        normals.push_back(normal);
    }

    void add_points() {
        for (std::size_t i = 0; i < count_ && data_.remaining_bytes() > 0; ++i) {
            add(vector(data_), Vec3(0, 0, 1));
        }
    }

    void add_line() {
        const Vec3 direction = vector(data_);
        const bool even = data_.ConsumeBool();
        for (std::size_t i = 0; i < count_; ++i)
            add(direction * (even ? static_cast<double>(i) / 64 : random_.uniform()), Vec3(0, 0, 1));
    }

    void add_lattice() {
        const int n = data_.ConsumeIntegralInRange<int>(1, 6),
                  layers = data_.ConsumeIntegralInRange<int>(1, n);
        for (int x = 0; x < n; ++x)
            for (int y = 0; y < n; ++y)
                for (int z = 0; z < layers; ++z) add(Vec3(x, y, z) * 0.25, Vec3(0, 0, 1));
    }

    void add_plane() {
        const double tilt = data_.ConsumeBool() ? number(data_) : 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const double x = random_.uniform(-1, 1), y = random_.uniform(-1, 1);
            add(Vec3(x, y, tilt * x), Vec3(-tilt, 0, 1).normalize_cond());
        }
    }

    void add_sphere() {
        for (std::size_t i = 0; i < count_; ++i) {
            const Vec3 d = random_.direction();
            add(d, d);
        }
    }

    void add_box() {
        const Vec3 half{1.0, power(data_, -5, 1), power(data_, -5, 1)};
        for (std::size_t i = 0; i < count_; ++i) {
            const std::size_t axis = random_.below(3);
            const double side = random_.below(2) == 0 ? -1 : 1;
            Vec3 p{random_.uniform(-1, 1), random_.uniform(-1, 1), random_.uniform(-1, 1)}, normal(0, 0, 0);
            p[axis] = normal[axis] = side;
            add(p * half, normal);
        }
    }

    void add_cylinder() {
        for (std::size_t i = 0; i < count_; ++i) {
            const double angle = random_.uniform(0, 2 * std::numbers::pi);
            const Vec3 normal(std::cos(angle), std::sin(angle), 0);
            add(normal * 0.5 + Vec3(0, 0, random_.uniform(-1, 1)), normal);
        }
    }

    void add_cluster() {
        const double spread = power(data_, -40, 0);
        for (std::size_t i = 0; i < count_; ++i) {
            const Vec3 p = spread * random_.gauss3();
            add(p, random_.direction());
        }
    }

    void add_sheets() {
        const double gap = power(data_, -10, 0);
        const bool same_way = data_.ConsumeBool();
        for (std::size_t i = 0; i < count_; ++i) {
            const bool upper = i % 2 == 0;
            add(Vec3{random_.uniform(-1, 1), random_.uniform(-1, 1), upper ? gap : 0.0},
                Vec3(0, 0, upper || same_way ? 1 : -1));
        }
    }

    void add_copies() {
        if (positions.empty()) return;
        const std::size_t from = data_.ConsumeIntegralInRange<std::size_t>(0, positions.size() - 1);
        const std::size_t end = std::min(positions.size(), from + count_);
        for (std::size_t i = from; i < end && left() > 0; ++i) {
            positions.push_back(Vec3(positions[i]));
            normals.push_back(random_.below(4) == 0 ? -normals[i] : Vec3(normals[i]));
        }
    }

    FuzzedDataProvider& data_;
    Random random_{0};
    double size_ = 1, noise_ = 0;
    Vec3 center_;
    std::size_t count_ = 0;
};

void spoil_normals(FuzzedDataProvider& data, std::vector<Vec3>& normals) {
    const int way = data.ConsumeIntegralInRange<int>(0, 7);
    Random random(data.ConsumeIntegral<std::uint8_t>());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (Vec3& normal : normals) switch (way) {
        case 0:
            if (random.below(2) == 0) normal = -normal;
            break;
        case 1:
            normal = -normal;
            break;
        case 2:
            if (random.below(4) == 0) normal = Vec3(0, 0, 0);
            break;
        case 3:
            normal = random.direction();
            break;
        case 4:
            if (random.below(4) == 0) normal = Vec3(nan, nan, random.uniform());
            break;
        case 5:
            normal *= std::ldexp(1.0, static_cast<int>(random.below(2000)) - 1000);
            break;
        default:
            break;
        }
}

void add_attributes(FuzzedDataProvider& data, PointCloud& cloud) {
    const int kinds = data.ConsumeIntegralInRange<int>(0, 15);
    Random random(data.ConsumeIntegral<std::uint8_t>());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (kinds & 1)
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            const std::uint64_t bits = random.bits();
            const auto byte = [bits](int shift) { return static_cast<std::uint8_t>(bits >> shift); };
            cloud.colors.push_back({byte(0), byte(8), byte(16), byte(24)});
        }
    constexpr std::array names{"quality",      "label",    "",    "hsdm_level", "hsdm_vertex_class",
                               "hsdm_normals", "v:points", "red", "quality",    "x",
                               "stamp",        "nx"};
    const auto add = [&](bool label, auto value) {
        Scalar scalar{data.PickValueInArray(names), {}, label};
        for (std::size_t i = 0; i < cloud.size(); ++i) scalar.values.push_back(value());
        cloud.scalars.push_back(std::move(scalar));
    };
    if (kinds & 2) add(true, [&] { return static_cast<double>(random.below(5)) - 1; });
    if (kinds & 4) add(false, [&] { return random.below(8) == 0 ? nan : random.uniform(-1, 1); });
    if (kinds & 8) add(false, [&] { return std::ldexp(random.gauss(), 1020); });
}

} // namespace

FuzzedCloud cloud_from(FuzzedDataProvider& data) {
    FuzzedCloud fuzzed;
    if (data.ConsumeIntegralInRange<int>(0, 3) == 0)
        fuzzed.exponent = data.ConsumeIntegralInRange<int>(-1000, 1000);
    const bool with_normals = data.ConsumeBool();
    Vec3 offset(0, 0, 0);
    if (data.ConsumeIntegralInRange<int>(0, 7) == 0) {
        offset = vector(data);
        offset *= power(data, 0, 30);
    }
    Cloud pieces(data);
    for (int piece = data.ConsumeIntegralInRange<int>(1, 5); piece > 0 && pieces.left() > 0; --piece)
        pieces.add_piece();
    PointCloud& cloud = fuzzed.cloud;
    cloud.positions = std::move(pieces.positions);
    for (Vec3& p : cloud.positions)
        for (std::size_t k = 0; k < 3; ++k) p[k] = std::ldexp(p[k] + offset[k], fuzzed.exponent);
    if (with_normals) {
        cloud.normals = std::move(pieces.normals);
        spoil_normals(data, cloud.normals);
    }
    add_attributes(data, cloud);
    if (data.ConsumeIntegralInRange<int>(0, 7) == 0)
        cloud.sensor = std::ldexp(1, fuzzed.exponent) * vector(data);
    return fuzzed;
}

ReconstructOptions options_from(FuzzedDataProvider& data, int exponent) {
    ReconstructOptions options;
    const auto length = [&](int least, int most) {
        if (data.ConsumeIntegralInRange<int>(0, 31) == 0) return number(data);
        const double mantissa = data.ConsumeFloatingPointInRange<double>(0.5, 1);
        return std::ldexp(mantissa, data.ConsumeIntegralInRange<int>(least, most) + exponent);
    };
    switch (data.ConsumeIntegralInRange<int>(0, 7)) {
    case 0:
    case 1:
    case 2:
        options.depth = data.ConsumeIntegralInRange<int>(1, 7);
        break;
    case 3:
        options.voxel_size = length(-7, 4);
        break;
    case 4:
        options.max_error = MaxError{length(-12, 2), false};
        break;
    case 5:
        options.max_error = MaxError{std::ldexp(1, data.ConsumeIntegralInRange<int>(-14, 0)), true};
        break;
    case 6:
        options.depth = data.ConsumeIntegralInRange<int>(-1, 18); // not all of them are depths
        break;
    default:
        break;
    }
    options.grid = data.PickValueInArray({Grid::automatic, Grid::uniform, Grid::adaptive});
    options.method = data.PickValueInArray({Method::automatic, Method::basic, Method::extended});
    options.normals = data.PickValueInArray(
        {NormalSource::automatic, NormalSource::automatic, NormalSource::given, NormalSource::estimate});
    options.holes = data.PickValueInArray({Holes::automatic, Holes::keep, Holes::close});
    options.merge_layers = data.ConsumeIntegralInRange<int>(0, 3) == 0;
    if (data.ConsumeIntegralInRange<int>(0, 3) == 0) {
        const bool share = data.ConsumeBool();
        options.min_component = MinComponent{share ? data.ConsumeIntegral<std::uint8_t>() / 200.0
                                                   : data.ConsumeIntegral<std::uint8_t>(),
                                             share};
    }
    if (data.ConsumeIntegralInRange<int>(0, 3) == 0)
        options.crease_angle = data.ConsumeIntegral<std::uint8_t>() / 80.0; // 3.19: beyond pi
    if (data.ConsumeIntegralInRange<int>(0, 3) == 0)
        options.normal_smoothing = data.ConsumeIntegralInRange<int>(-1, 40);
    options.classify = data.ConsumeIntegralInRange<int>(0, 7) != 0;
    options.vertex_normals = data.ConsumeIntegralInRange<int>(0, 7) != 0;
    options.measure = data.ConsumeIntegralInRange<int>(0, 7) != 0;
    return options;
}

} // namespace hsdm::fuzz
