#include "hsdm/errors.hh"
#include "hsdm/io/columns.hh"
#include "hsdm/io/text.hh"

#include <algorithm>
#include <bitset>

namespace hsdm::io {
namespace {

constexpr std::size_t role_count = 12;

struct Alias {
    std::string_view name;
    Role role;
};

/// Beside the plain letters: PLY files in the wild, CSV headers of point-cloud tools (`points:0` and the like
/// are how a vector's components are numbered there).
constexpr Alias aliases[] = {
    {"x", Role::x},
    {"y", Role::y},
    {"z", Role::z},
    {"pos_x", Role::x},
    {"pos_y", Role::y},
    {"pos_z", Role::z},
    {"position_x", Role::x},
    {"position_y", Role::y},
    {"position_z", Role::z},
    {"points:0", Role::x},
    {"points:1", Role::y},
    {"points:2", Role::z},
    {"points_0", Role::x},
    {"points_1", Role::y},
    {"points_2", Role::z},
    {"nx", Role::nx},
    {"ny", Role::ny},
    {"nz", Role::nz},
    {"n_x", Role::nx},
    {"n_y", Role::ny},
    {"n_z", Role::nz},
    {"normal_x", Role::nx},
    {"normal_y", Role::ny},
    {"normal_z", Role::nz},
    {"normalx", Role::nx},
    {"normaly", Role::ny},
    {"normalz", Role::nz},
    {"normals:0", Role::nx},
    {"normals:1", Role::ny},
    {"normals:2", Role::nz},
    {"normals_0", Role::nx},
    {"normals_1", Role::ny},
    {"normals_2", Role::nz},
    {"r", Role::red},
    {"g", Role::green},
    {"b", Role::blue},
    {"red", Role::red},
    {"green", Role::green},
    {"blue", Role::blue},
    {"rf", Role::red},
    {"gf", Role::green},
    {"bf", Role::blue},
    {"diffuse_red", Role::red},
    {"diffuse_green", Role::green},
    {"diffuse_blue", Role::blue},
    {"a", Role::alpha},
    {"alpha", Role::alpha},
    {"diffuse_alpha", Role::alpha},
    {"_", Role::skip},
    {"", Role::skip},
};

constexpr std::string_view label_names[] = {"label",          "labels",    "label_id", "class",
                                            "classification", "segment",   "segments", "segmentation",
                                            "object",         "object_id", "instance", "instance_id",
                                            "cluster",        "category",  "part"};
constexpr std::string_view scalar_names[] = {"intensity",  "reflectance", "reflectivity", "quality",
                                             "confidence", "curvature",   "time",         "gps_time"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

/// A vector or colour that lacks a component, and a name given twice, is a scalar like any other.
void demote_incomplete(std::vector<Column>& columns) {
    std::bitset<role_count> present;
    for (Column& column : columns) {
        const auto role = static_cast<std::size_t>(column.role);
        if (column.role < Role::scalar && present[role]) column.role = Role::scalar;
        present.set(role);
    }
    const auto has = [&](Role role) { return present[static_cast<std::size_t>(role)]; };
    const bool normals = has(Role::nx) && has(Role::ny) && has(Role::nz);
    const bool colors = has(Role::red) && has(Role::green) && has(Role::blue);
    for (Column& column : columns) {
        const bool normal = column.role >= Role::nx && column.role <= Role::nz;
        const bool color = column.role >= Role::red && column.role <= Role::alpha;
        if ((normal && !normals) || (color && !colors)) column.role = Role::scalar;
    }
}

bool has_position(std::span<const Column> columns) {
    for (Role role : {Role::x, Role::y, Role::z})
        if (std::none_of(columns.begin(), columns.end(), [=](const Column& c) { return c.role == role; }))
            return false;
    return true;
}

} // namespace

bool is_label_name(std::string_view name) {
    std::string plain = lower(name);
    if (plain.starts_with("scalar_")) plain.erase(0, 7);
    return contains(label_names, plain);
}

Role role_of(std::string_view name) {
    const std::string plain = lower(name);
    for (const Alias& alias : aliases)
        if (alias.name == plain) return alias.role;
    return Role::scalar;
}

std::vector<Column> parse_columns(const std::string& list) {
    std::vector<Column> columns;
    std::bitset<role_count> present;
    for (std::size_t at = 0; at <= list.size();) {
        const std::size_t comma = std::min(list.find(',', at), list.size());
        const std::string name(trim(std::string_view(list).substr(at, comma - at)));
        at = comma + 1;
        const Role role = role_of(name);
        const std::string plain = lower(name);
        if (name.empty() || (role == Role::scalar && !contains(scalar_names, plain) && !is_label_name(plain)))
            throw OptionError(
                "columns: " + quoted(name)
                + " is no column; known are x y z nx ny nz r g b a intensity label, and _ for one "
                  "to skip, e.g. x,y,z,_,nx,ny,nz");
        if (role < Role::scalar && present[static_cast<std::size_t>(role)])
            throw OptionError("columns: " + quoted(name) + " is there twice; name each column once");
        present.set(static_cast<std::size_t>(role));
        columns.push_back({role, plain});
    }
    if (!has_position(columns)) throw OptionError("columns: x, y and z must all be there, e.g. x,y,z,_");
    std::vector<Column> complete = columns;
    demote_incomplete(complete);
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns[i].role != complete[i].role)
            throw OptionError("columns: " + quoted(columns[i].name)
                              + " is not complete; give nx, ny and nz or none, r, g and b or none");
    return columns;
}

std::string list_of(std::span<const Column> columns) {
    constexpr std::string_view names[] = {"x", "y", "z", "nx", "ny", "nz", "r", "g", "b", "a"};
    static_assert(std::size(names) == static_cast<std::size_t>(Role::scalar));
    std::string list;
    for (const Column& column : columns) {
        list += list.empty() ? "" : ",";
        if (column.role == Role::skip)
            list += '_';
        else
            list += column.role == Role::scalar ? column.name : names[static_cast<std::size_t>(column.role)];
    }
    return list;
}

std::optional<std::vector<Column>> columns_from_names(std::span<const std::string> names) {
    std::vector<Column> columns;
    for (const std::string& name : names) columns.push_back({role_of(name), name});
    if (!has_position(columns)) return std::nullopt;
    demote_incomplete(columns);
    return columns;
}

} // namespace hsdm::io
