// Plots as SVG files: lines and named points over axes that may be logarithmic.
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace hsdm::bench {

/// What an axis shows.
struct Axis {
    std::string title;
    double least, most;
    std::vector<double> ticks;
    bool logarithmic = true;
};

/// A place in the axes' units.
struct PlotPoint {
    double x, y;
};

/// Draws what it is given over its axes; what lies outside of them is drawn at their ends.
class Plot {
public:
    Plot(const Axis& x, const Axis& y);

    /// A line through points, its name in the legend.
    void line(const std::vector<PlotPoint>& points, const std::string& name);
    /// A point with its name beside it, higher or lower where another's name would be in the way.
    void mark(const PlotPoint& point, const std::string& name);
    /// A thin line between two points, its name at the second.
    void guide(const PlotPoint& from, const PlotPoint& to, const std::string& name);
    /// Throws Error if the file cannot be written.
    void write(const std::string& path) const;

private:
    double across(double x) const;
    double down(double y) const;
    void text(double x, double y, const std::string& what, const char* colour);

    double free_height(double x, double y, double width);

    struct Label {
        double x, y, width;
    };

    Axis x_, y_;
    std::size_t lines_ = 0;
    std::vector<Label> labels_;
    std::ostringstream shapes_;
};

/// 1, 2, 5, 10, ... between two positive numbers, both included.
std::vector<double> round_ticks(double least, double most);

} // namespace hsdm::bench
