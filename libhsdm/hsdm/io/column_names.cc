#include "hsdm/errors.hh"
#include "hsdm/io/columns.hh"
#include "hsdm/io/text.hh"

#include <algorithm>
#include <array>
#include <bitset>

namespace hsdm::io {
namespace {

constexpr std::size_t role_count = 12;

/// The three names of a vector or colour.
struct Alias {
    std::array<std::string_view, 3> names;
    Role first; ///< of the first name; those of the others follow
};

/// Beside the plain letters: PLY files in the wild, CSV headers of point-cloud tools (`points:0` and the like
/// are how a vector's components are numbered there).
constexpr Alias aliases[] = {
    {{"x", "y", "z"}, Role::x},
    {{"pos_x", "pos_y", "pos_z"}, Role::x},
    {{"position_x", "position_y", "position_z"}, Role::x},
    {{"points:0", "points:1", "points:2"}, Role::x},
    {{"points_0", "points_1", "points_2"}, Role::x},
    {{"nx", "ny", "nz"}, Role::nx},
    {{"n_x", "n_y", "n_z"}, Role::nx},
    {{"normal_x", "normal_y", "normal_z"}, Role::nx},
    {{"normalx", "normaly", "normalz"}, Role::nx},
    {{"normals:0", "normals:1", "normals:2"}, Role::nx},
    {{"normals_0", "normals_1", "normals_2"}, Role::nx},
    {{"r", "g", "b"}, Role::red},
    {{"red", "green", "blue"}, Role::red},
    {{"rf", "gf", "bf"}, Role::red},
    {{"diffuse_red", "diffuse_green", "diffuse_blue"}, Role::red},
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
    if (plain.empty() || plain == "_") return Role::skip;
    if (plain == "a" || plain == "alpha" || plain == "diffuse_alpha") return Role::alpha;
    for (const auto& [names, first] : aliases)
        if (const auto at = std::ranges::find(names, plain) - names.begin(); at < 3)
            return static_cast<Role>(static_cast<int>(first) + static_cast<int>(at));
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
                "columns: " + io::quoted(name)
                + " is no column; known are x y z nx ny nz r g b a intensity label, and _ for one "
                  "to skip, e.g. x,y,z,_,nx,ny,nz");
        if (role < Role::scalar && present[static_cast<std::size_t>(role)])
            throw OptionError("columns: " + io::quoted(name) + " is there twice; name each column once");
        present.set(static_cast<std::size_t>(role));
        columns.push_back({role, plain});
    }
    if (!has_position(columns)) throw OptionError("columns: x, y and z must all be there, e.g. x,y,z,_");
    std::vector<Column> complete = columns;
    demote_incomplete(complete);
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns[i].role != complete[i].role)
            throw OptionError("columns: " + io::quoted(columns[i].name)
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
