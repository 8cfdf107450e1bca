#pragma once
// Colours and further scalars of points, one number at a time, and what several of them are together.

#include "hsdm/point_view.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// A channel of the points' colours, or a scalar of theirs, as it is carried to vertices.
struct PointAttribute {
    std::string name;
    VertexProperty::Type type = VertexProperty::Type::float64; ///< uint8: a channel; int32: labels
    StridedSpan rows;                                          ///< the colours, or the scalar's values
    std::size_t place = 0;                                     ///< among the channels or the scalars
    bool is_constant = false;                                  ///< alpha of colours that have none: opaque

    /// A point's value.
    double operator()(Index point) const;
};

/// Red, green, blue and alpha if the cloud has colours, and its scalars but for those that begin with `hsdm_`
/// (results of a reconstruction, whose names are those of the next) or have another's name. The cloud's
/// arrays must outlive them.
std::vector<PointAttribute> attributes_of(const PointView& cloud);

struct WeightedValue {
    double value;
    double weight; ///< >= 0
};

/// The mean of the finite values, summed in their own order (a scanner's "no value" is often NaN); NaN if
/// there is none, or none with a weight.
double mean_of(std::span<const WeightedValue> values);
/// The finite value of most weight, the least of several; 0 if there is none. Leaves the finite ones, sorted.
double majority_of(std::vector<WeightedValue>& values);
/// What an attribute of that type is where several are: the majority of labels, the mean of others, rounded
/// for channels of a colour. The values may be gone or in another order then.
double average_of(VertexProperty::Type type, std::vector<WeightedValue>& values);
/// The same whatever order they come in.
double average_of_equal(VertexProperty::Type type, std::vector<WeightedValue>& values);

} // namespace hsdm
