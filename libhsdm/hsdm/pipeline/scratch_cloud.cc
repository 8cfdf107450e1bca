#include "hsdm/pipeline/scratch_cloud.hh"

#include "hsdm/cloud/strided.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/kept_scratch.hh"
#include "hsdm/pipeline/cell_attributes.hh"
#include "hsdm/pipeline/near_cells.hh"
#include "hsdm/pipeline/point_exchange.hh"
#include "hsdm/pipeline/tile_plan.hh"

#include <algorithm>
#include <map>
#include <utility>

namespace hsdm {
namespace {

/// Not more than this, for what waits in many small vectors is not of use to large ones once it is freed.
std::size_t bytes_buffered(const TileOptions& options) {
    return std::clamp(options.memory / 16, std::size_t{1} << 20, std::size_t{1} << 26);
}

/// Points that wait to be sent, at most, each with so many bytes beside it; what comes takes as much again.
std::size_t points_waiting(const TileOptions& options, std::size_t beside) {
    constexpr std::size_t most = std::size_t{1} << 20;
    return std::min(most, bytes_buffered(options) / (sizeof(PointRow) + beside));
}

OctreeOptions octree_options(bool use_normals, const Box& whole) {
    OctreeOptions options;
    options.use_normals = use_normals;
    options.placement = CubePlacement::centred;
    options.whole = whole;
    return options;
}

/// A new file of a job that is kept, or one without a name.
ScratchPlace new_place(KeptScratch* kept, const std::string& folder) {
    return kept ? ScratchPlace{kept->folder(), kept->new_name("points"), 0} : ScratchPlace{folder, {}, 0};
}

} // namespace

ScratchCloud::ScratchCloud(const PointParts& parts, const CloudExtent& extent, int depth,
                           const TileOptions& options, Ranks& ranks, bool use_normals)
    : extent_(extent),
      frame_(extent.box),
      attributes_(extent.attributes),
      depth_(depth),
      cell_depth_(cell_depth_of(depth)),
      most_waiting_(points_waiting(options, attributes_.bytes())),
      kept_(options.kept),
      place_(new_place(kept_, options.scratch)),
      buffered_(bytes_buffered(options)),
      ranks_(ranks),
      scratch_(std::make_unique<ScratchPoints>(
          place_, extent.finite() / static_cast<std::size_t>(ranks.size()), buffered_, attributes_.bytes())),
      has_normals_(use_normals && extent.has_normals) {
    options_ = octree_options(has_normals_, extent.box);
    none_.extent = extent.box.extent();
    none_.origin = centred_origin(extent.box, none_.extent);
    none_.bounds = extent.box;
    for (Vec3& place : extent_.sample) place -= origin();
    divide(extent_.sample, extent_.sample_stride);
    release(extent_.sample);
    sort_points(parts);
    gather_cells();
}

ScratchCloud::ScratchCloud(ByteReader& bytes, const TileOptions& options, Ranks& ranks)
    : extent_(extent_from(bytes)),
      frame_(extent_.box),
      depth_(bytes.take<int>()),
      cell_depth_(cell_depth_of(depth_)),
      most_waiting_(points_waiting(options, AttributeRows(extent_.attributes).bytes())),
      kept_(options.kept),
      buffered_(bytes_buffered(options)),
      ranks_(ranks) {
    none_.extent = bytes.take<double>(), none_.origin = bytes.take<Vec3>(), none_.bounds = bytes.take<Box>();
    has_normals_ = bytes.take<bool>();
    arranged_ = bytes.take<bool>(), in_order_ = bytes.take<bool>();
    options_ = octree_options(has_normals_, extent_.box);
    begins_ = bytes.take_vector<MortonCode>(), fetched_ = bytes.take_vector<MortonCode>();
    cells_ = bytes.take_vector<ScratchPoints::Cell>();
    left_out_ = bytes.take_vector<PointRow>();
    if (bytes.take<bool>()) attributes_ = AttributeRows(extent_.attributes);
    count_cells();
    std::string name = bytes.take_text();
    place_ = {kept_->folder(), std::move(name), bytes.take<std::size_t>()};
    scratch_ = std::make_unique<ScratchPoints>(place_, bytes, buffered_, attributes_.bytes());
    note_kept();
}

void ScratchCloud::put_state(Ranks::Bytes& bytes) const {
    put_extent(extent_, bytes);
    put(depth_, bytes);
    put(none_.extent, bytes), put(none_.origin, bytes), put(none_.bounds, bytes);
    for (const bool is : {has_normals_, arranged_, in_order_}) put(is, bytes);
    put_vector(begins_, bytes), put_vector(fetched_, bytes);
    put_vector(cells_, bytes);
    put_vector(left_out_, bytes);
    put(attributes_.bytes() > 0, bytes);
    put_text(place_.name, bytes);
    put(scratch_->bytes(), bytes);
    scratch_->put_index(bytes);
}

MortonCode ScratchCloud::cell_of(const Vec3& relative) const {
    return code_at(relative, cube_extent()) >> 3 * (morton_levels - cell_depth_);
}

/// The cells of so many positions.
template <class Place>
std::vector<Index> ScratchCloud::cells_of(std::size_t count, const Place& place) const {
    std::vector<Index> cells = unwritten_vector<Index>(count);
    for_each_index(count, chunks::light, [&](Index i) { cells[i] = static_cast<Index>(cell_of(place(i))); });
    return cells;
}

Vec3 ScratchCloud::relative_place(const PointRow& row) const {
    const Vec3 place(row[0], row[1], row[2]);
    return arranged_ ? place : place - origin();
}

/// Each rank gets cells that about as many points of the samples lie in.
void ScratchCloud::divide(std::span<const Vec3> sample, std::size_t stride) {
    std::map<MortonCode, double> weights;
    for (const Vec3& place : sample) weights[cell_of(place)] += 1;
    Ranks::Bytes bytes;
    for (const auto& [cell, count] : weights) {
        put(cell, bytes);
        put(count * static_cast<double>(stride), bytes);
    }
    weights.clear();
    double total = 0;
    for (const Ranks::Bytes& got : ranks_.gather(bytes))
        for (ByteReader reader(got); !reader.at_end();) {
            const auto cell = reader.take<MortonCode>();
            const auto weight = reader.take<double>();
            weights[cell] += weight, total += weight;
        }
    begins_.assign(1, 0);
    double before = 0;
    for (const auto& [cell, weight] : weights) {
        while (begins_.size() < static_cast<std::size_t>(ranks_.size())
               && before >= total * static_cast<double>(begins_.size()) / ranks_.size())
            begins_.push_back(cell);
        before += weight;
    }
    begins_.resize(static_cast<std::size_t>(ranks_.size()), MortonCode{1} << 3 * cell_depth_);
}

int ScratchCloud::owner(MortonCode cell) const {
    return static_cast<int>(std::ranges::upper_bound(begins_, cell) - begins_.begin()) - 1;
}

std::vector<MortonCode> ScratchCloud::borders() const {
    std::vector<MortonCode> borders;
    for (const ScratchPoints::Cell& cell : cells_)
        if (&cell != &cells_.front() && owner(cell.code) != owner((&cell - 1)->code))
            borders.push_back(cell.code);
    return borders;
}

/// To the rank that has its cell.
void ScratchCloud::put_row(const PointRow& row, const char* beside, MortonCode cell,
                           PointExchange& exchange) {
    if (const int to = owner(cell); to != ranks_.rank())
        exchange.add(to, row, beside);
    else
        scratch_->add(cell, row, beside);
}

/// Where all ranks' points that come go.
PointExchange ScratchCloud::exchange_into(ScratchCloud& next) {
    return {next.ranks_, next.most_waiting_, next.attributes_.bytes(),
            [&next](const PointRow& row, const char* beside) {
                next.scratch_->add(next.cell_of(next.relative_place(row)), row, beside);
            }};
}

/// This rank's part of the points goes to those that have their cells.
void ScratchCloud::sort_points(const PointParts& parts) {
    PointExchange exchange = exchange_into(*this);
    std::size_t added = 0;
    std::vector<char> beside(attributes_.bytes());
    parts([&](const PointView& part) {
        const std::vector<PointAttribute> attributes = attributes_.in(part);
        const std::vector<std::int32_t> scanners = extent_.scanners.numbers_in(part);
        const std::vector<Index> cells =
            cells_of(part.size(), [&](Index i) { return vec3_at(part.positions, i) - origin(); });
        for_each_in_order(part.size(), [&](std::size_t i) {
            const Vec3 p = vec3_at(part.positions, i);
            const Vec3 n = has_normals_ ? vec3_at(part.normals, i) : Vec3(0, 0, 0);
            if (!is_finite(p)) return;
            attributes_.write(attributes, static_cast<Index>(i), beside.data());
            if (attributes_.has_scanners()) {
                const std::int32_t own = scanner_of(part, i);
                attributes_.set_scanner(beside.data(),
                                        own < 0 ? -1 : scanners[static_cast<std::size_t>(own)]);
            }
            put_row({p[0], p[1], p[2], n[0], n[1], n[2]}, beside.data(), cells[i], exchange);
            ++added;
        });
    });
    exchange.finish();
    scratch_->finish();
    if (ranks_.sum(added) != extent_.finite())
        throw Error("the points have changed while they were read; read them again");
}

void ScratchCloud::gather_cells() {
    cells_.clear();
    for (const Ranks::Bytes& got : ranks_.gather(bytes_of(scratch_->cells())))
        for (const auto& cell : ByteReader(got).take_rest<ScratchPoints::Cell>()) cells_.push_back(cell);
    count_cells();
}

void ScratchCloud::count_cells() {
    first_of_cell_.clear();
    Index number = 0;
    for (const ScratchPoints::Cell& cell : cells_) {
        first_of_cell_.push_back(number);
        if (cell.points >= between_points - number)
            throw Error(
                "fewer than 2^32 - 2 points can be told apart, those added where they are sparse too");
        number += static_cast<Index>(cell.points);
    }
}

ScratchCloud::NumberedCell ScratchCloud::cell_with(Index number) const {
    const auto after = std::ranges::upper_bound(first_of_cell_, number);
    const auto place = static_cast<std::size_t>(after - first_of_cell_.begin()) - 1;
    return {cells_[place].code, first_of_cell_[place], cells_[place].points};
}

std::size_t ScratchCloud::points_before() const {
    std::size_t points = 0;
    for (const ScratchPoints::Cell& cell : cells_)
        if (owner(cell.code) < ranks_.rank()) points += cell.points;
    return points;
}

std::size_t ScratchCloud::points_here() const {
    std::size_t points = 0;
    for (const ScratchPoints::Cell& cell : cells_)
        if (owner(cell.code) == ranks_.rank()) points += cell.points;
    return points;
}

OctreeLevel ScratchCloud::no_voxels() const {
    OctreeLevel level;
    level.depth = depth_;
    level.voxel_size = voxel_size();
    return level;
}

/// The rows as they came, as one octree.
Octree ScratchCloud::first_octree(const std::vector<CellRows>& parts, std::size_t points) const {
    std::vector<PointRow> rows;
    rows.reserve(points);
    for (const CellRows& part : parts)
        if (part.is_whole)
            scratch_->read(part.cell, rows);
        else
            append_large(rows, part.rows);
    PointView view;
    view.positions = StridedSpan(rows.front().data(), rows.size(), sizeof(PointRow));
    view.normals = StridedSpan(rows.front().data() + 3, rows.size(), sizeof(PointRow));
    OctreeOptions options = options_;
    options.tell_duplicates = attributes_.bytes() > 0;
    Octree octree = build_octree(view, options);
    if (attributes_.bytes() > 0) number_points(parts, octree);
    return octree;
}

/// From places in the parts to numbers.
void ScratchCloud::number_points(const std::vector<CellRows>& parts, Octree& octree) const {
    const auto to_number = [&](Index& place) {
        const auto after = std::ranges::upper_bound(parts, place, {}, &CellRows::first);
        const CellRows& part = *(after - 1);
        place = part.number_of(place - part.first);
    };
    for_each_index(octree.size(), chunks::usual, [&](Index i) { to_number(octree.source[i]); });
    for (Octree::Duplicate& equal : octree.duplicates) to_number(equal.first), to_number(equal.other);
}

/// The rows of octrees as one, but for what they are in the cloud: nothing is rounded or merged.
Octree ScratchCloud::arranged_octree(const std::vector<CellRows>& parts, std::size_t points) const {
    Octree octree = none_;
    std::vector<Vec3> positions = unwritten_vector<Vec3>(points);
    if (has_normals_) resize_unwritten(octree.normals, points);
    resize_unwritten(octree.source, points);
    for_each_task(parts.size(), [&](std::size_t k) {
        const CellRows& part = parts[k];
        std::vector<PointRow> whole;
        if (part.is_whole) scratch_->read(part.cell, whole);
        const std::vector<PointRow>& rows = part.is_whole ? whole : part.rows;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const std::size_t i = part.first + r;
            positions[i] = Vec3(rows[r][0], rows[r][1], rows[r][2]);
            if (has_normals_) octree.normals[i] = Vec3(rows[r][3], rows[r][4], rows[r][5]);
            octree.source[i] = part.number_of(r);
        }
    });
    hsdm::rearrange(octree, std::move(positions), octree.extent);
    return octree;
}

Octree ScratchCloud::octree_of(std::vector<CellRows> parts) const {
    std::size_t points = 0;
    for (CellRows& part : parts) {
        const std::size_t cell = place_of(part.cell);
        part.first = points, part.number = first_of_cell_[cell];
        points += part.is_whole ? cells_[cell].points : part.rows.size();
    }
    if (points == 0) return none_;
    Octree octree = arranged_ ? arranged_octree(parts, points) : first_octree(parts, points);
    if (!left_out_.empty()) {
        std::vector<std::uint8_t> marks = large_vector<std::uint8_t>(octree.size(), 0);
        for_each_index(octree.size(), chunks::usual,
                       [&](Index i) { marks[i] = std::ranges::binary_search(left_out_, row_at(octree, i)); });
        remove_points(octree, marks);
    }
    return octree;
}

/// Of cells along an edge, so many that no voxel beyond them is within `ghost` voxels.
int ScratchCloud::cells_within(int ghost) const {
    const int side = 1 << (depth_ - cell_depth_);
    return (ghost + side - 1) / side;
}

std::vector<MortonCode> ScratchCloud::missing_cells(const std::vector<Surroundings>& wanted) const {
    std::vector<MortonCode> missing;
    for (const Surroundings& w : wanted)
        for (const MortonCode cell : cells_near(cells_of(w.range), cells_within(w.ghost), cells_))
            if (owner(cell) != ranks_.rank() && !std::ranges::binary_search(fetched_, cell))
                missing.push_back(cell);
    sort_unique(missing);
    return missing;
}

void ScratchCloud::fetch(const std::vector<Surroundings>& wanted) {
    if (ranks_.size() == 1) return;
    const std::vector<MortonCode> missing = missing_cells(wanted);
    std::vector<Ranks::Bytes> out(static_cast<std::size_t>(ranks_.size()));
    for (const MortonCode cell : missing) put(cell, out[static_cast<std::size_t>(owner(cell))]);
    const std::vector<Ranks::Bytes> requests = ranks_.exchange(std::move(out));
    PointExchange exchange = exchange_into(*this);
    std::vector<PointRow> rows;
    std::vector<char> beside;
    for (std::size_t to = 0; to < requests.size(); ++to)
        for (const auto cell : ByteReader(requests[to]).take_rest<MortonCode>()) {
            rows.clear();
            scratch_->read(cell, rows);
            scratch_->read_beside(cell, beside);
            for (std::size_t i = 0; i < rows.size(); ++i)
                exchange.add(static_cast<int>(to), rows[i], beside.data() + i * attributes_.bytes());
        }
    exchange.finish();
    scratch_->finish();
    fetched_.insert(fetched_.end(), missing.begin(), missing.end());
    std::ranges::sort(fetched_);
}

/// The range of cells of a range of voxels, as voxels of the cells' level.
VoxelRange ScratchCloud::cells_of(const VoxelRange& range) const {
    const int shift = 3 * (depth_ - cell_depth_);
    return {range.begin >> shift, range.end >> shift, cell_depth_, 0};
}

/// Points of a cell within so many voxels of the range.
void ScratchCloud::read_near(const VoxelRange& range, int ghost, CellRows& part) const {
    std::vector<PointRow> rows;
    scratch_->read(part.cell, rows);
    const int to_level = 3 * (morton_levels - depth_);
    MortonCode voxel = ~MortonCode{0};
    bool is_near = false; // that voxel; points that come in order are asked about voxel by voxel
    for (std::size_t i = 0; i < rows.size(); ++i) { // often a corner of the cell is near
        const MortonCode at = code_at(relative_place(rows[i]), cube_extent()) >> to_level;
        if (at != voxel) voxel = at, is_near = range.is_near(morton_decode(voxel), ghost);
        if (is_near) part.rows.push_back(rows[i]), part.places.push_back(static_cast<Index>(i));
    }
    part.rows.shrink_to_fit(), part.places.shrink_to_fit();
}

Octree ScratchCloud::octree_around(const VoxelRange& range, int ghost) const {
    const VoxelRange of_cells = cells_of(range);
    std::vector<CellRows> parts;
    for (const MortonCode cell : cells_near(of_cells, cells_within(ghost), cells_))
        parts.push_back({cell, of_cells.holds(cell)});
    for_each_task(parts.size(), [&](std::size_t k) {
        if (!parts[k].is_whole) read_near(range, ghost, parts[k]);
    });
    return octree_of(std::move(parts));
}

Octree ScratchCloud::octree_of_cells(const VoxelRange& range, int ghost,
                                     std::vector<MortonCode>& missing) const {
    const std::vector<MortonCode> near = cells_near(cells_of(range), cells_within(ghost), cells_);
    missing.clear();
    for (const ScratchPoints::Cell& cell : cells_)
        if (!std::ranges::binary_search(near, cell.code)) missing.push_back(cell.code);
    std::vector<CellRows> parts;
    parts.reserve(near.size());
    for (const MortonCode cell : near) parts.push_back({cell, true});
    return octree_of(std::move(parts));
}

void ScratchCloud::for_groups(std::size_t most, const std::function<void(const Octree&)>& visit) const {
    std::vector<CellRows> group;
    std::size_t points = 0;
    const auto is_own = [&](const ScratchPoints::Cell& cell) { return owner(cell.code) == ranks_.rank(); };
    const auto first = std::ranges::find_if(cells_, is_own);
    for (auto c = first; c != cells_.end() && is_own(*c); ++c) {
        group.push_back({c->code, true});
        points += c->points;
        const auto next = c + 1;
        if (next != cells_.end() && is_own(*next) && points + next->points <= most) continue;
        visit(octree_of(std::exchange(group, {})));
        points = 0;
    }
}

void ScratchCloud::sort_in_cells(std::size_t most, const std::function<void(const Octree&)>& visit) {
    if (in_order_) return for_groups(most, visit);
    ScratchCloud next = emptied(has_normals_, true);
    CellAttributes beside(*this);
    for_groups(most, [&](const Octree& part) {
        for_each_in_order(part.size(), [&](std::size_t i) { next.add(part, i, beside.of(part, i)); });
        visit(part);
    });
    next.finish_sorted();
    take(std::move(next));
}

void ScratchCloud::for_tiles(std::span<const VoxelRange> ranges, int ghost,
                             const std::function<void(const Octree&, const VoxelRange&)>& visit) {
    std::vector<Surroundings> own;
    for (const VoxelRange& range : ranges)
        if (owner_of(range) == ranks_.rank()) own.push_back({range, ghost});
    fetch(own);
    for (const Surroundings& tile : own) {
        const Octree octree = octree_around(tile.range, ghost);
        if (octree.size() > 0) visit(octree, tile.range);
    }
}

void ScratchCloud::leave_out(std::vector<PointRow> rows) {
    left_out_ = std::move(rows);
    std::ranges::sort(left_out_);
    ++version_;
}

Box ScratchCloud::box_in_cube(std::size_t most) const {
    Box own, all;
    for_groups(most, [&](const Octree& part) { own.add(bounds_of(part.positions)); });
    Ranks::Bytes bytes;
    put(own, bytes);
    for (const Ranks::Bytes& got : ranks_.gather(bytes)) all.add(ByteReader(got).take<Box>());
    return all;
}

Box ScratchCloud::box_of_points(std::size_t most) const {
    const Box box = box_in_cube(most);
    return {box.lo + origin(), box.hi + origin()};
}

ScratchCloud::ScratchCloud(const ScratchCloud& before, const Cube& cube, const AttributeRows& attributes,
                           KeptScratch* kept)
    : extent_(before.extent_),
      frame_(before.frame_),
      attributes_(attributes),
      options_(before.options_),
      none_(before.none_),
      depth_(cube.depth),
      cell_depth_(cell_depth_of(depth_)),
      most_waiting_(before.most_waiting_),
      kept_(kept),
      place_(new_place(kept_, before.place_.folder)),
      buffered_(before.buffered_),
      ranks_(before.ranks_),
      scratch_(std::make_unique<ScratchPoints>(place_, before.points_here(), buffered_, attributes_.bytes())),
      has_normals_(before.has_normals_),
      arranged_(true) {
    none_.bounds = cube.bounds, none_.origin = cube.origin, none_.extent = cube.extent;
}

/// The same for points of another one that lie elsewhere in this cube.
void ScratchCloud::divide(const ScratchCloud& before, const Vec3& shift, std::size_t most) {
    const std::size_t stride = before.points_here() / most_sampled + 1;
    std::vector<Vec3> sample;
    std::size_t number = 0;
    if (ranks_.size() > 1)
        before.for_groups(most, [&](const Octree& part) {
            for (const Vec3& p : part.positions)
                if (number++ % stride == 0) sample.push_back(p + shift);
        });
    divide(sample, stride);
}

void ScratchCloud::rearrange(const Box& bounds, double extent, int depth, std::size_t most) {
    // as rearrange() of an octree has it
    const Vec3 corner = extent != cube_extent() ? centred_origin(bounds, extent) : origin();
    ScratchCloud next(*this, {bounds, corner, extent, depth}, attributes_, kept_);
    const Vec3 shift = origin() - next.origin();
    next.divide(*this, shift, most);
    PointExchange exchange = exchange_into(next);
    CellAttributes beside(*this);
    for_groups(most, [&](const Octree& part) {
        const auto place = [&](std::size_t i) { return part.positions[i] + shift; };
        const std::vector<Index> cells = next.cells_of(part.size(), place);
        for_each_in_order(part.size(), [&](std::size_t i) {
            PointRow row = row_at(part, i);
            std::copy_n(place(i).data(), 3, row.begin());
            next.put_row(row, beside.of(part, i), cells[i], exchange);
        });
    });
    exchange.finish();
    next.scratch_->finish();
    next.gather_cells();
    take(std::move(next));
}

void ScratchCloud::take(ScratchCloud&& next) {
    none_ = std::move(next.none_);
    depth_ = next.depth_, cell_depth_ = next.cell_depth_;
    if (kept_ && !std::exchange(is_of_pass_, false)) kept_->remove_file(place_.name);
    scratch_ = std::move(next.scratch_), place_ = std::move(next.place_);
    has_normals_ = next.has_normals_;
    arranged_ = next.arranged_, in_order_ = next.in_order_;
    attributes_ = std::move(next.attributes_);
    begins_ = std::move(next.begins_);
    cells_ = std::move(next.cells_), first_of_cell_ = std::move(next.first_of_cell_);
    fetched_ = std::vector<MortonCode>(), left_out_ = std::vector<PointRow>();
    ++version_;
}

PointRow ScratchCloud::row_at(const Octree& octree, std::size_t point) {
    const Vec3& p = octree.positions[point];
    const Vec3 n = octree.has_normals() ? octree.normals[point] : Vec3(0, 0, 0);
    return {p[0], p[1], p[2], n[0], n[1], n[2]};
}

ScratchCloud ScratchCloud::emptied(bool has_normals, bool carries) const {
    ScratchCloud next(*this, cube(), carries ? attributes_ : AttributeRows(), kept_);
    next.begins_ = begins_;
    next.has_normals_ = has_normals;
    return next;
}

void ScratchCloud::add(const Octree& octree, std::size_t point, const char* beside) {
    add(octree.codes[point], row_at(octree, point), beside);
}

void ScratchCloud::add(MortonCode code, const PointRow& row, const char* beside) {
    scratch_->add(code >> 3 * (morton_levels - cell_depth_), row, beside);
}

void ScratchCloud::finish_sorted() {
    scratch_->finish();
    gather_cells();
    in_order_ = true;
}

void ScratchCloud::fill(const std::function<void(const PutRow& put_row)>& work) {
    PointExchange exchange = exchange_into(*this);
    work([&](const PointRow& row, const char* beside) {
        put_row(row, beside, cell_of(relative_place(row)), exchange);
    });
    exchange.finish();
    scratch_->finish();
    gather_cells();
}

} // namespace hsdm
