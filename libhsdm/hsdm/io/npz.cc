// NPZ: several NPY arrays in a ZIP archive, each a member by its name.

#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/npy.hh"
#include "hsdm/io/zip_archive.hh"

#include <algorithm>
#include <deque>

namespace hsdm::io {
namespace {

struct Member {
    std::size_t index; ///< in the archive
    std::string name;  ///< of the array
    NpyArray array;
};

bool is_scalar(const Member& member) {
    return !member.array.structured && member.array.width() == 1 && member.array.fields.size() == 1;
}
bool is_table(const Member& member) {
    return member.array.structured || (member.array.shape.size() >= 2 && member.array.width() >= 3);
}

class NpzReader {
public:
    explicit NpzReader(const SourceBytes& bytes) : bytes_(bytes), archive_(bytes) {
        for (std::size_t i = 0; i < archive_.size(); ++i) {
            const std::string& name = archive_.name(i);
            if (name.ends_with(".npy")) add_member(i, name.substr(0, name.size() - 4));
        }
        if (members_.empty())
            throw Error(bytes.name(), "is a ZIP archive without arrays; save it by np.savez");
    }

    PointFile read(const std::string& columns) {
        PointFile file;
        file.format = "npz";
        if (!columns.empty() && !find_table())
            throw OptionError("columns: " + bytes_.name() + " has no array of points; leave the option out");
        if (const Member* points = find_table())
            add_points(*points, columns, file);
        else
            add_axes();
        for (const Member& member : members_) add_attribute(member);
        file.cloud = read_columns(all_.values, all_.columns, rows_);
        return file;
    }

private:
    /// Arrays that hold no numbers are passed by, unless points are looked for in them.
    void add_member(std::size_t index, const std::string& name) {
        const std::size_t total = archive_.bytes_of(index);
        const SourceBytes head = archive_.read(index, SourceBytes::head_size);
        try {
            members_.push_back({index, name, read_npy_header(head, total)});
        } catch (const Error&) {
            if (vector_name(name) != VectorName::none || archive_.size() == 1) throw;
        }
    }

    /// The only one that is called points or the like, else the only one that may be points.
    const Member* find_table() const {
        const Member *named = nullptr, *any = nullptr;
        std::size_t tables = 0;
        for (const Member& member : members_) {
            if (!is_table(member)) continue;
            if (!named && vector_name(member.name) == VectorName::position) named = &member;
            const bool other = vector_name(member.name) == VectorName::normal
                               || vector_name(member.name) == VectorName::color
                               || member.array.fields.empty(); // texts
            if (!other) any = &member;
            tables += !other;
        }
        return named ? named : tables == 1 ? any : nullptr;
    }

    const SourceBytes& load(const Member& member) {
        sources_.push_back(archive_.read(member.index, archive_.bytes_of(member.index)));
        return sources_.back();
    }

    void add_points(const Member& points, const std::string& columns, PointFile& file) {
        bool told = false;
        all_ = columns_of_points(points.array, load(points), columns, told);
        if (told) file.columns = list_of(all_.columns);
        rows_ = points.array.rows();
        used_ = {points.name};
    }

    /// Three arrays of one number for each point.
    void add_axes() {
        for (const std::string axis : {"x", "y", "z"}) {
            const auto found = std::ranges::find_if(
                members_, [&](const Member& m) { return lower(m.name) == axis && is_scalar(m); });
            if (found == members_.end()) fail_without_points();
            if (used_.empty()) rows_ = found->array.rows();
            if (found->array.rows() != rows_ || rows_ == 0) fail_without_points();
            all_.add({role_of(axis), axis}, plain_column(found->array, load(*found), 0));
            used_.push_back(found->name);
        }
    }

    [[noreturn]] void fail_without_points() const {
        std::string list;
        for (const Member& member : members_)
            list += (list.empty() ? "" : ", ") + member.name + ' ' + member.array.shape_words();
        throw Error(bytes_.name(),
                    "has no array of points, only " + io::quoted(list) + "; call one of shape (n, 3) points");
    }

    void add_attribute(const Member& member) {
        if (std::ranges::find(used_, member.name) != used_.end()) return;
        const VectorName kind = vector_name(member.name);
        if (kind == VectorName::normal || kind == VectorName::color) {
            add_vector(member, kind == VectorName::normal ? Role::nx : Role::red);
        } else if (is_scalar(member) && member.array.rows() == rows_ && all_.columns.size() < most_columns) {
            all_.add({Role::scalar, member.name}, plain_column(member.array, load(member), 0));
        }
    }

    void add_vector(const Member& member, Role first) {
        const std::size_t width = member.array.width();
        if (all_.has(first)) return;
        if (member.array.structured || member.array.fields.empty() || member.array.rows() != rows_
            || !(width == 3 || (width == 4 && first == Role::red)))
            throw Error(bytes_.name(), "the array " + io::quoted(member.name) + " is of shape "
                                           + member.array.shape_words() + ", which does not fit "
                                           + std::to_string(rows_) + " points; correct it, or leave it out");
        if (member.array.fortran && member.array.shape.size() > 2)
            throw Error(bytes_.name(), "the array " + io::quoted(member.name)
                                           + " is in Fortran's order; save it with np.ascontiguousarray");
        const SourceBytes& source = load(member);
        for (std::size_t k = 0; k < width; ++k)
            all_.add({static_cast<Role>(static_cast<std::size_t>(first) + k), member.name},
                     plain_column(member.array, source, k));
    }

    const SourceBytes& bytes_;
    ZipArchive archive_;
    std::vector<Member> members_;
    std::deque<SourceBytes> sources_; ///< what the columns lie in
    ArrayColumns all_;
    std::vector<std::string> used_;
    std::size_t rows_ = 0;
};

} // namespace

bool is_npz(const SourceBytes& bytes) {
    constexpr std::size_t header = 30, length_at = 26; // of a member, before its name
    const std::string_view head = bytes.head();
    if (!head.starts_with("PK\x03\x04") || head.size() < header) return false;
    double length = 0;
    gather_of(StoredType::uint16, false)(head.data() + length_at, 0, 1, &length);
    return head.substr(header, static_cast<std::size_t>(length)).ends_with(".npy");
}

PointFile read_npz(const SourceBytes& bytes, const std::string& columns) {
    return NpzReader(bytes).read(columns);
}

} // namespace hsdm::io
