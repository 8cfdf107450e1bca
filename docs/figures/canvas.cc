#include "canvas.hh"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace hsdm::figures {
namespace {

constexpr double line_height = 21, mark_width = 34;

std::string number(double x) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f", x);
    std::string result = text.data();
    if (result.ends_with(".0")) result.resize(result.size() - 2);
    return result == "-0" ? "0" : result;
}

std::string pair(const Vec2& p) {
    return number(p[0]) + " " + number(p[1]);
}

std::string attribute(const std::string& name, const std::string& value) {
    return " " + name + "=\"" + value + "\"";
}

std::string attributes(const Style& style) {
    std::string result = attribute("fill", style.fill);
    if (style.stroke != colour::none)
        result += attribute("stroke", style.stroke) + attribute("stroke-width", number(style.width));
    if (!style.dash.empty()) result += attribute("stroke-dasharray", style.dash);
    if (style.opacity < 1) result += attribute("opacity", number(style.opacity));
    return result;
}

std::string escaped(const std::string& words) {
    std::string result;
    for (const char c : words)
        result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return result;
}

} // namespace

namespace colour {

const std::string& patch(std::size_t i) {
    static const std::array<std::string, 5> colours{sky, yellow, purple, "#9bd3a8", orange};
    return colours[i % colours.size()];
}

std::string darkened(const std::string& hex, double share) {
    std::array<char, 8> text{};
    std::array<int, 3> part{};
    for (std::size_t i = 0; i < 3; ++i)
        part[i] =
            static_cast<int>(std::lround(share * std::stoi(hex.substr(1 + 2 * i, 2), nullptr, 16))) & 255;
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", static_cast<unsigned>(part[0]) & 255u,
                  static_cast<unsigned>(part[1]) & 255u, static_cast<unsigned>(part[2]) & 255u);
    return text.data();
}

} // namespace colour

Canvas::Canvas(double width, double height) : width_(width), height_(height) {
    rectangle({0, 0}, {width, height}, {.stroke = colour::none, .fill = colour::white});
}

void Canvas::line(const Vec2& a, const Vec2& b, const Style& style) {
    body_ += "<path d=\"M" + pair(a) + "L" + pair(b) + "\"" + attributes(style) + "/>\n";
}

void Canvas::arrow(const Vec2& tail, const Vec2& tip, const Style& style) {
    const Vec2 along = tip - tail;
    const double length = along.norm();
    if (length < 1e-6) return;
    const Vec2 unit = along / length, across(-unit[1], unit[0]);
    const double head = std::min(3.5 + 2 * style.width, 0.7 * length);
    line(tail, tip - 0.8 * head * unit, style);
    const std::array<Vec2, 3> corners{tip, tip - head * unit + 0.5 * head * across,
                                      tip - head * unit - 0.5 * head * across};
    polygon(corners, {.stroke = colour::none, .fill = style.stroke});
}

void Canvas::circle(const Vec2& centre, double radius, const Style& style) {
    body_ += "<circle" + attribute("cx", number(centre[0])) + attribute("cy", number(centre[1]))
             + attribute("r", number(radius)) + attributes(style) + "/>\n";
}

void Canvas::square(const Vec2& centre, double half, const Style& style) {
    rectangle(centre - Vec2(half, half), centre + Vec2(half, half), style);
}

void Canvas::cross(const Vec2& centre, double half, const Style& style) {
    const Vec2 down(half, half), up(half, -half);
    body_ += "<path d=\"M" + pair(centre - down) + "L" + pair(centre + down) + "M" + pair(centre - up) + "L"
             + pair(centre + up) + "\"" + attributes(style) + "/>\n";
}

void Canvas::rectangle(const Vec2& a, const Vec2& b, const Style& style) {
    body_ += "<rect" + attribute("x", number(a[0])) + attribute("y", number(a[1]))
             + attribute("width", number(b[0] - a[0])) + attribute("height", number(b[1] - a[1]))
             + attributes(style) + "/>\n";
}

void Canvas::polygon(std::span<const Vec2> corners, const Style& style) {
    body_ += "<path d=\"M";
    for (std::size_t i = 0; i < corners.size(); ++i) body_.append(i > 0 ? "L" : "").append(pair(corners[i]));
    body_ += "Z\"" + attributes(style) + "/>\n";
}

void Canvas::lines(std::span<const std::array<Vec2, 2>> segments, const Style& style) {
    if (segments.empty()) return;
    body_ += "<path stroke-linecap=\"round\" d=\"";
    for (const auto& [a, b] : segments) body_.append("M").append(pair(a)).append("L").append(pair(b));
    body_.append("\"").append(attributes(style)).append("/>\n");
}

void Canvas::text(const Vec2& at, const std::string& words, double size, const std::string& anchor,
                  bool bold) {
    body_ += "<text" + attribute("x", number(at[0])) + attribute("y", number(at[1]))
             + attribute("font-size", number(size)) + attribute("text-anchor", anchor)
             + (bold ? attribute("font-weight", "bold") : "") + ">" + escaped(words) + "</text>\n";
}

void Canvas::legend(Vec2 at, std::span<const Entry> entries) {
    for (const Entry& entry : entries) {
        const Vec2 middle = at + Vec2(0.5 * mark_width - 5, 0.5 * line_height);
        const Vec2 half(11, 0);
        switch (entry.mark) {
        case Entry::Mark::none:
            break;
        case Entry::Mark::dot:
            circle(middle, entry.size, entry.style);
            break;
        case Entry::Mark::square:
            square(middle, entry.size, entry.style);
            break;
        case Entry::Mark::line:
            line(middle - half, middle + half, entry.style);
            break;
        case Entry::Mark::cross:
            cross(middle, entry.size, entry.style);
            break;
        case Entry::Mark::arrow:
            arrow(middle - half, middle + half, entry.style);
            break;
        }
        const bool heading = entry.mark == Entry::Mark::none && entry.size > 0;
        text({heading ? at[0] : at[0] + mark_width, middle[1] + 4.5}, entry.text, 13, "start", heading);
        at[1] += line_height;
    }
}

void Canvas::begin_clip(const Vec2& a, const Vec2& b) {
    std::string name = "c";
    name += std::to_string(clips_++);
    body_ += "<clipPath" + attribute("id", name) + ">";
    rectangle(a, b, {.stroke = colour::none, .fill = colour::white});
    body_ += "</clipPath><g" + attribute("clip-path", "url(#" + name + ")") + ">\n";
}

void Canvas::end_clip() {
    body_ += "</g>\n";
}

void Canvas::save(const std::string& path) const {
    std::ofstream out(path);
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\"" << attribute("width", number(width_))
        << attribute("height", number(height_))
        << attribute("viewBox", "0 0 " + number(width_) + " " + number(height_))
        << attribute("font-family", "DejaVu Sans, Verdana, sans-serif") << ">\n"
        << body_ << "</svg>\n";
    if (!out.flush()) throw std::runtime_error(path + ": could not be written");
}

} // namespace hsdm::figures
