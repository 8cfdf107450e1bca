#include "plot.hh"

#include "hsdm/errors.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

namespace hsdm::bench {
namespace {

constexpr double left = 62, right = 590, top = 14, bottom = 330;
/// Told apart by those who do not see all colours (Okabe, Ito 2008).
constexpr std::array<const char*, 8> line_colours{"#000000", "#e69f00", "#56b4e9", "#009e73",
                                                  "#d55e00", "#0072b2", "#cc79a7", "#999999"};

double share_along(const Axis& axis, double value) {
    const double clamped = std::clamp(value, axis.least, axis.most);
    return axis.logarithmic ? std::log(clamped / axis.least) / std::log(axis.most / axis.least)
                            : (clamped - axis.least) / (axis.most - axis.least);
}

std::string text_of_tick(double value) {
    const double millions = value / 1e6, thousands = value / 1e3;
    std::ostringstream out;
    if (millions >= 1)
        out << millions << " M";
    else if (thousands >= 1)
        out << thousands << " k";
    else
        out << value;
    return out.str();
}

} // namespace

std::vector<double> round_ticks(double least, double most) {
    std::vector<double> ticks;
    for (double decade = std::pow(10, std::floor(std::log10(least))); decade <= most; decade *= 10)
        for (const double digit : {1, 2, 5})
            if (digit * decade >= 0.999 * least && digit * decade <= 1.001 * most)
                ticks.push_back(digit * decade);
    return ticks;
}

Plot::Plot(const Axis& x, const Axis& y) : x_(x), y_(y) {
    for (const double tick : y.ticks) {
        shapes_ << "<path stroke='#ddd' d='M" << left << ' ' << down(tick) << "H" << right << "'/>\n";
        text(22, down(tick) + 4, text_of_tick(tick), "#333");
    }
    for (const double tick : x.ticks) {
        shapes_ << "<path stroke='#eee' d='M" << across(tick) << ' ' << top << "V" << bottom << "'/>\n";
        text(across(tick) - 8, bottom + 16, text_of_tick(tick), "#333");
    }
    text(left, bottom + 34, x.title, "#333");
    shapes_ << "<text transform='translate(14 " << bottom << ") rotate(-90)' fill='#333'>" << y.title
            << "</text>\n";
}

void Plot::line(const std::vector<PlotPoint>& points, const std::string& name) {
    const char* const colour = line_colours[lines_ % line_colours.size()];
    const bool again = lines_ >= line_colours.size(); // the same colours, dashed
    shapes_ << "<polyline fill='none' stroke='" << colour << "' stroke-width='2'"
            << (again ? " stroke-dasharray='6 3'" : "") << " points='";
    for (const PlotPoint& p : points) shapes_ << across(p.x) << ',' << down(p.y) << ' ';
    shapes_ << "'/>\n";
    for (const PlotPoint& p : points)
        shapes_ << "<circle cx='" << across(p.x) << "' cy='" << down(p.y) << "' r='3' fill='" << colour
                << "'/>\n";
    text(right + 10, top + 12 + 18 * static_cast<double>(lines_), again ? "- " + name : name, colour);
    ++lines_;
}

void Plot::mark(const PlotPoint& point, const std::string& name) {
    shapes_ << "<circle cx='" << across(point.x) << "' cy='" << down(point.y) << "' r='4' fill='#0072b2'/>\n";
    constexpr double letter = 6.4; // in the mean
    const double x = across(point.x) + 6, y = down(point.y) + 4;
    text(x, free_height(x, y, letter * static_cast<double>(name.size())), name, "#333");
}

/// The nearest height at which a label of this width covers no other.
double Plot::free_height(double x, double y, double width) {
    constexpr double line = 11, step = 4;
    const auto is_free = [&](double height) {
        return std::none_of(labels_.begin(), labels_.end(), [&](const Label& other) {
            return std::abs(height - other.y) < line && x < other.x + other.width && other.x < x + width;
        });
    };
    double height = y;
    for (int i = 1; i < 60 && !is_free(height); ++i)
        height = std::clamp(y + (i % 2 ? -step : step) * (i + 1) / 2, top + line, bottom);
    labels_.push_back({x, height, width});
    return height;
}

void Plot::guide(const PlotPoint& from, const PlotPoint& to, const std::string& name) {
    shapes_ << "<path stroke='#d55e00' stroke-dasharray='5 3' d='M" << across(from.x) << ' ' << down(from.y)
            << "L" << across(to.x) << ' ' << down(to.y) << "'/>\n";
    text(across(to.x) + 4, down(to.y) + 4, name, "#d55e00");
}

void Plot::write(const std::string& path) const {
    std::ofstream file(path);
    file << "<svg xmlns='http://www.w3.org/2000/svg' width='720' height='372' font-family='sans-serif' "
            "font-size='12'>\n<rect width='720' height='372' fill='white'/>\n"
         << shapes_.str() << "</svg>\n";
    if (!file.flush()) throw Error(path, "cannot be written");
}

double Plot::across(double x) const {
    return left + (right - left) * share_along(x_, x);
}

double Plot::down(double y) const {
    return bottom - (bottom - top) * share_along(y_, y);
}

void Plot::text(double x, double y, const std::string& what, const char* colour) {
    shapes_ << "<text x='" << x << "' y='" << y << "' fill='" << colour << "'>" << what << "</text>\n";
}

} // namespace hsdm::bench
