// SPDX-License-Identifier: GPL-3.0-or-later
// The complete state as bytes. Wall lists are not stored: they are functions of the positions when grains were listed,
// which are, so that the loaded system sums in the same order as the saved one.
//
// Layout: Header; cells; positions now, and (fraction bits) when listed; ids, groups, records, half-step velocities and spins; per slot its
// row count and rows (neighbours, histories); wall histories; poses and states of bodies; impulses; release times.
// Native byte order.
#include <cstring>

#include "core/error.hpp"
#include "dem/grain_system.hpp"

namespace gdesp::dem {
namespace {

constexpr std::uint64_t checkpoint_mark = 0x32304d4544504447ull;  // "GDPDEM02"

struct Header {
  std::uint64_t mark = checkpoint_mark;
  double time = 0.0, half_before = 0.0, drift = 0.0, odometer = 0.0, skin = 0.0;
  float moved2 = 0.0f, speed2 = 0.0f, overlap = 0.0f;
  std::int32_t must_rebuild = 0, rolling = 0, reserved = 0;
  std::int64_t substeps = 0, rebuilds = 0, listed_at = 0;
  Index slots = 0, lost = 0;
};

class Writer {
 public:
  template <class T>
  void put(const T& value) {
    const char* p = reinterpret_cast<const char*>(&value);
    bytes.insert(bytes.end(), p, p + sizeof(T));
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    const char* p = reinterpret_cast<const char*>(values.data());
    bytes.insert(bytes.end(), p, p + values.size() * sizeof(T));
  }
  template <class T, class Exec>
  void put(const Array<T, Exec>& array) {
    put(array.to_host());
  }
  /// What archive() of a class hands over.
  template <class... Parts>
  void operator()(const Parts&... parts) {
    (put(parts), ...);
  }
  std::vector<char> bytes;
};

class Reader {
 public:
  explicit Reader(const std::vector<char>& bytes) : bytes_(bytes) {}
  template <class T>
  T get() {
    T value;
    take(&value, sizeof(T));
    return value;
  }
  template <class T>
  std::vector<T> get_vector() {
    const auto count = get<std::uint64_t>();
    if (count > (bytes_.size() - at_) / sizeof(T)) fail();
    std::vector<T> values(static_cast<std::size_t>(count));
    take(values.data(), values.size() * sizeof(T));
    return values;
  }
  template <class... Parts>
  void operator()(Parts&... parts) {
    (fill(parts), ...);
  }
  bool done() const { return at_ == bytes_.size(); }
  [[noreturn]] static void fail() {
    throw Error(ErrorKind::input, "checkpoint: the state of the grains is cut short or not of this version");
  }

 private:
  template <class T>
  void fill(T& value) {
    value = get<T>();
  }
  template <class T, class Exec>
  void fill(Array<T, Exec>& array) {
    array.assign(get_vector<T>());
  }
  void take(void* to, std::size_t size) {
    if (size > bytes_.size() - at_) fail();
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }
  const std::vector<char>& bytes_;
  std::size_t at_ = 0;
};

// Member by member: the padding of a struct has no defined bytes.
void put_body(Writer& w, const BodyMotionState& body) {
  w.put(body.centre_initial);
  w.put(body.centre_begin);
  w.put(body.centre_end);
  w.put(body.rotation_begin);
  w.put(body.rotation_end);
  w.put(static_cast<std::int32_t>(body.present));
}
BodyMotionState get_body(Reader& r) {
  BodyMotionState body;
  body.centre_initial = r.get<Vec3d>();
  body.centre_begin = r.get<Vec3d>();
  body.centre_end = r.get<Vec3d>();
  for (double& x : body.rotation_begin) x = r.get<double>();
  for (double& x : body.rotation_end) x = r.get<double>();
  body.present = r.get<std::int32_t>() != 0;
  return body;
}

// Rows in the order of slots: where the overflow rows lie depends on the threads.
struct OrderedRows {
  std::vector<RowRange> range;
  std::vector<ContactRow> rows;
  std::vector<RollingRow> rolling;
};

OrderedRows in_order(const std::vector<RowRange>& range, const std::vector<ContactRow>& rows,
                     const std::vector<RollingRow>& rolling) {
  OrderedRows ordered;
  auto next = static_cast<Index>(range.size());
  ordered.range = range;
  ordered.rows.assign(rows.begin(), rows.begin() + next);
  if (!rolling.empty()) ordered.rolling.assign(rolling.begin(), rolling.begin() + next);
  for (std::size_t i = 0; i < range.size(); ++i) {
    if (range[i].count == 0) {
      ordered.rows[i] = ContactRow{};
      if (!rolling.empty()) ordered.rolling[i] = RollingRow{};
    }
    const Index extra = range[i].count > 8 ? (range[i].count - 1) / 8 : 0;
    ordered.range[i].overflow = extra > 0 ? next : 0;
    for (Index k = 0; k < extra; ++k, ++next) {
      const auto from = static_cast<std::size_t>(range[i].overflow + k);
      ordered.rows.push_back(rows[from]);
      if (!rolling.empty()) ordered.rolling.push_back(rolling[from]);
    }
  }
  return ordered;
}

struct StartPositions {
  const FixedPosition* now;
  const Vec3<std::int32_t>* start;
  FixedPosition* out;
  GDESP_HD void operator()(Index i) const {
    const FixedPosition& p = now[i];
    out[i] = {p.x + fraction_difference(start[i].x, static_cast<std::int32_t>(Domain::fraction_of(p.x))),
              p.y + fraction_difference(start[i].y, static_cast<std::int32_t>(Domain::fraction_of(p.y))),
              p.z + fraction_difference(start[i].z, static_cast<std::int32_t>(Domain::fraction_of(p.z)))};
  }
};

}  // namespace

template <class Exec>
std::vector<char> GrainSystem<Exec>::save() {
  Writer w;
  Header header;
  header.time = time_;
  header.half_before = half_before_;
  header.moved2 = moved2_;
  header.speed2 = speed2_;
  header.overlap = overlap_;
  header.drift = drift_;
  header.odometer = odometer_;
  header.skin = skin_;
  header.listed_at = listed_at_;
  header.must_rebuild = must_rebuild_ ? 1 : 0;
  header.rolling = contact_.rolling_friction > 0.0 ? 1 : 0;
  header.substeps = substeps_;
  header.rebuilds = rebuilds_;
  header.slots = slots_;
  header.lost = lost_;
  w.put(header);
  set_.archive(w);
  w.put(position_.to_host());
  w.put(start_.to_host());
  w.put(id_.to_host());
  w.put(group_.to_host());
  w.put(now_.to_host());
  w.put(velocity_.to_host());
  w.put(spin_.to_host());
  w.put(quiet_until_.to_host());
  const OrderedRows ordered =
      in_order(contacts_.ranges().to_host(), contacts_.rows().to_host(), contacts_.rolling_rows().to_host());
  w.put(ordered.range);
  w.put(ordered.rows);
  w.put(ordered.rolling);
  w.put(walls_.history().to_host());
  w.put(walls_.impulse_units());
  w.put(listed_poses_);
  w.put(static_cast<std::uint64_t>(bodies_.size()));
  for (const BodyMotionState& body : bodies_) put_body(w, body);
  w.put(release_time_);
  w.put(held_group_);
  return w.bytes;
}

template <class Exec>
void GrainSystem<Exec>::load(const std::vector<char>& bytes) {
  Reader r(bytes);
  const auto header = r.get<Header>();
  if (header.mark != checkpoint_mark || header.rolling != (contact_.rolling_friction > 0.0 ? 1 : 0)) Reader::fail();
  set_.archive(r);
  const auto position = r.get_vector<FixedPosition>();
  slots_ = header.slots;
  position_.assign(position);
  start_.assign(r.get_vector<Vec3<std::int32_t>>());
  id_.assign(r.get_vector<std::uint32_t>());
  group_.assign(r.get_vector<std::int32_t>());
  now_.assign(r.get_vector<GrainRecord>());
  velocity_.assign(r.get_vector<Vec3f>());
  spin_.assign(r.get_vector<Vec3f>());
  const auto quiet_until = r.get_vector<float>();
  quiet_until_.assign(quiet_until);
  const auto range = r.get_vector<RowRange>();
  const auto rows = r.get_vector<ContactRow>();
  const auto rolling = r.get_vector<RollingRow>();
  const auto wall_history = r.get_vector<WallHistory>();
  walls_.set_impulse_units(r.get_vector<std::int64_t>());
  listed_poses_ = r.get_vector<ListedPose>();
  bodies_.clear();
  for (auto left = r.get<std::uint64_t>(); left > 0; --left) bodies_.push_back(get_body(r));
  release_time_ = r.get_vector<double>();
  held_group_ = r.get_vector<std::int32_t>();
  if (!r.done() || position.size() != static_cast<std::size_t>(slots_) || set_.slots() != slots_) Reader::fail();
  time_ = header.time;
  half_before_ = header.half_before;
  drift_ = header.drift;
  odometer_ = header.odometer;
  skin_ = header.skin;
  listed_at_ = static_cast<long>(header.listed_at);
  moved2_ = header.moved2;
  speed2_ = header.speed2;
  overlap_ = header.overlap;
  must_rebuild_ = header.must_rebuild != 0;
  substeps_ = static_cast<long>(header.substeps);
  rebuilds_ = static_cast<long>(header.rebuilds);
  lost_ = header.lost;
  restore_lists(range, rows, rolling, wall_history, quiet_until);
}

template <class Exec>
void GrainSystem<Exec>::restore_lists(const std::vector<RowRange>& range, const std::vector<ContactRow>& rows,
                                      const std::vector<RollingRow>& rolling,
                                      const std::vector<WallHistory>& wall_history,
                                      const std::vector<float>& quiet_until) {
  Array<FixedPosition, Exec> listed_position(exec_);
  listed_position.resize_discard(static_cast<std::size_t>(slots_));
  exec::parallel_for(exec_, "dem::restore", slots_,
                     StartPositions{position_.data(), start_.data(), listed_position.data()});
  contacts_.ranges().assign(range);
  contacts_.rows().assign(rows);
  contacts_.rolling_rows().assign(rolling);
  if (!walls_.empty()) {
    walls_.history().assign(wall_history);
    // Asks every grain, as the lists were made from readings that are gone; the readings saved are then put back.
    quiet_until_.fill_bytes(0);
    walls_.build(set_, listed_position, now_.data(), listed_poses_, wall_reach(), false, next_);
    quiet_until_.assign(quiet_until);
  }
  next_.assign(now_.to_host());
  set_fluid({});
  listed_ = true;
}

template std::vector<char> GrainSystem<exec::CompiledBackend>::save();
template void GrainSystem<exec::CompiledBackend>::load(const std::vector<char>&);

}  // namespace gdesp::dem
