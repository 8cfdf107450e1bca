#pragma once
// A drawing in pixels that is saved as SVG, on a white ground, in the colours of Okabe and Ito.

#include <OpenMesh/Core/Geometry/VectorT.hh>

#include <span>
#include <string>
#include <vector>

namespace hsdm::figures {

using Vec2 = OpenMesh::Vec2d;

/// Told apart by all common kinds of colour vision.
namespace colour {
inline const std::string none = "none", black = "#000000", white = "#ffffff", grey = "#8a8a8a",
                         pale = "#dddddd", faint = "#f2f2f2", orange = "#e69f00", sky = "#56b4e9",
                         green = "#009e73", yellow = "#f0e442", blue = "#0072b2", red = "#d55e00",
                         purple = "#cc79a7";
/// One of five that are as light as each other, by turns.
const std::string& patch(std::size_t i);
/// `share` of a colour, the rest black.
std::string darkened(const std::string& hex, double share);
} // namespace colour

struct Style {
    std::string stroke = colour::black;
    double width = 1; ///< pixels
    std::string fill = colour::none;
    std::string dash = ""; ///< lengths in pixels, as SVG has them
    double opacity = 1;
};

/// A line of the legend: a mark and what it stands for. A text without a mark is a heading.
struct Entry {
    enum class Mark { none, dot, square, line, cross, arrow } mark = Mark::none;
    Style style = {};
    std::string text = "";
    double size = 4;
};

class Canvas {
public:
    Canvas(double width, double height);

    void line(const Vec2& a, const Vec2& b, const Style& style);
    void arrow(const Vec2& tail, const Vec2& tip, const Style& style);
    void circle(const Vec2& centre, double radius, const Style& style);
    void square(const Vec2& centre, double half, const Style& style);
    void cross(const Vec2& centre, double half, const Style& style);
    void rectangle(const Vec2& a, const Vec2& b, const Style& style);
    void polygon(std::span<const Vec2> corners, const Style& style);
    /// Many lines of one style in one element.
    void lines(std::span<const std::array<Vec2, 2>> segments, const Style& style);
    void text(const Vec2& at, const std::string& words, double size = 13, const std::string& anchor = "start",
              bool bold = false);
    /// From its upper left corner down.
    void legend(Vec2 at, std::span<const Entry> entries);

    /// What is drawn between the two is cut off at the rectangle.
    void begin_clip(const Vec2& a, const Vec2& b);
    void end_clip();

    /// Throws std::runtime_error.
    void save(const std::string& path) const;

private:
    double width_, height_;
    std::string body_;
    int clips_ = 0;
};

/// Where a part of the plane lies on the canvas; the plane's y goes up.
struct Panel {
    Vec2 corner;  ///< on the canvas: the upper left one
    Vec2 lo, hi;  ///< of the part of the plane
    double scale; ///< pixels per unit

    Vec2 operator()(const Vec2& p) const {
        return {corner[0] + scale * (p[0] - lo[0]), corner[1] + scale * (hi[1] - p[1])};
    }
    Vec2 size() const { return {scale * (hi[0] - lo[0]), scale * (hi[1] - lo[1])}; }
    bool holds(const Vec2& p, double margin = 0) const {
        return p[0] > lo[0] - margin && p[1] > lo[1] - margin && p[0] < hi[0] + margin
               && p[1] < hi[1] + margin;
    }
};

} // namespace hsdm::figures
