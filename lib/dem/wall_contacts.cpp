// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/wall_contacts.hpp"

#include <cmath>

#include "exec/permute.hpp"

namespace gdesp::dem {
namespace {

GDESP_HD inline Vec3d apply(const double* m, const Vec3d& a) {
  return {m[0] * a.x + m[1] * a.y + m[2] * a.z, m[3] * a.x + m[4] * a.y + m[5] * a.z,
          m[6] * a.x + m[7] * a.y + m[8] * a.z};
}

// Squared distance from p to a triangle, m2.
// Source: Ericson (2005), Real-Time Collision Detection, section 5.1.5, doi:10.1201/b14581.
GDESP_HD inline double triangle_distance2(const Vec3d& p, const TriangleCorners& t) {
  const Vec3d ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return dot(ap, ap);
  const Vec3d bp = p - t.b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return dot(bp, bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const Vec3d r = ap - (d1 / (d1 - d3)) * ab;
    return dot(r, r);
  }
  const Vec3d cp = p - t.c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return dot(cp, cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const Vec3d r = ap - (d2 / (d2 - d6)) * ac;
    return dot(r, r);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const Vec3d r = bp - ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (t.c - t.b);
    return dot(r, r);
  }
  const double sum = 1.0 / (va + vb + vc);
  const Vec3d r = ap - (vb * sum) * ab - (vc * sum) * ac;
  return dot(r, r);
}

// Finds the triangles near a grain.
struct WallSearch {
  Domain domain;
  WallMeshView mesh;
  const ListedPose* poses;
  const FixedPosition* position;
  const GrainRecord* records;
  float skin;

  GDESP_HD static float box_distance2(const WallNode& node, const Vec3f& p) {
    float sum = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const float out = real::max(0.0f, real::max(node.lower[axis] - p[axis], p[axis] - node.upper[axis]));
      sum += out * out;
    }
    return sum;
  }
  // Whether the plane of a triangle is farther than reach: decides most cases.
  GDESP_HD bool plane_is_far(Index t, const Vec3d& p, double reach) const {
    const double height = dot(static_cast<Vec3d>(mesh.frame[t].n), p - mesh.corners[t].a);
    const double rounding = 2.0e-7 * (std::fabs(p.x - mesh.corners[t].a.x) + std::fabs(p.y - mesh.corners[t].a.y) +
                                      std::fabs(p.z - mesh.corners[t].a.z));
    return std::fabs(height) > reach + rounding;
  }
  // visit(triangle, point, distance) with the point in body coordinates (those of the corners).
  template <class Visit>
  GDESP_HD void in_body(Index body, const Vec3d& point, double reach, const Visit& visit) const {
    const WallBody& b = mesh.body[body];
    const Vec3f p = static_cast<Vec3f>(point - b.middle);
    const float reach_f = static_cast<float>(reach) * 1.00001f;
    Index stack[64];
    int depth = 0;
    stack[depth++] = b.root;
    while (depth > 0) {
      const WallNode& node = mesh.node[stack[--depth]];
      if (box_distance2(node, p) > reach_f * reach_f) continue;
      if (node.count == 0) {
        stack[depth++] = node.first + 1;
        stack[depth++] = node.first;
        continue;
      }
      for (Index t = node.first; t < node.first + node.count; ++t) {
        if (plane_is_far(t, point, reach)) continue;
        const double distance2 = triangle_distance2(point, mesh.corners[t]);
        if (distance2 <= reach * reach) visit(t, point, distance2);
      }
    }
  }
  // The images of x that may touch a wall across a periodic border: shift -1, 0, 1 of an axis.
  GDESP_HD bool image_needed(double x, int axis, int shift, double reach) const {
    if (shift == 0) return true;
    if (!domain.periodic[axis]) return false;
    const double period = domain.tile_size[axis] * domain.tiles[axis], place = x - domain.lower[axis];
    return shift > 0 ? place < reach : place > period - reach;
  }
  GDESP_HD double list_reach(Index i) const { return static_cast<double>(records[i].radius) + skin; }
  // The triangles within reach (m) of the centre of grain i.
  template <class Visit>
  GDESP_HD void operator()(Index i, double reach, const Visit& visit) const {
    const Vec3d x = domain.metres(position[i]);
    for (Index body = 0; body < mesh.bodies; ++body) {
      const ListedPose& pose = poses[body];
      if (mesh.body[body].root < 0 || !pose.present) continue;
      for (int sx = -1; sx <= 1; ++sx) {
        if (!image_needed(x.x, 0, sx, reach)) continue;
        for (int sy = -1; sy <= 1; ++sy) {
          if (!image_needed(x.y, 1, sy, reach)) continue;
          const Vec3d image{x.x + sx * domain.tile_size.x * domain.tiles.x,
                            x.y + sy * domain.tile_size.y * domain.tiles.y, x.z};
          in_body(body, apply(pose.to_body, image - pose.centre) + pose.centre_initial, reach, visit);
        }
      }
    }
  }
};

// Looks for walls where they may have come near: a grain that was far from all walls is not asked again before grains
// and bodies together have moved that far (odometer).
struct CountRows {
  WallSearch search;
  double odometer, look_ahead;  // m
  float* quiet_until;           // m, by slot
  Index* near;
  Index* rows_needed;

  GDESP_HD Index count(Index i) const {
    const GrainRecord& own = search.records[i];
    if (!(own.radius > 0.0f && own.mobility > 0.0f) || static_cast<double>(quiet_until[i]) > odometer + search.skin)
      return 0;
    Index found = 0;
    search(i, search.list_reach(i), [&](Index, const Vec3d&, double) { ++found; });
    if (found > 0) return found;
    double nearest2 = (search.list_reach(i) + look_ahead) * (search.list_reach(i) + look_ahead);
    search(i, search.list_reach(i) + look_ahead,
           [&](Index, const Vec3d&, double distance2) { nearest2 = distance2 < nearest2 ? distance2 : nearest2; });
    quiet_until[i] = static_cast<float>(odometer + 0.999 * (::sqrt(nearest2) - own.radius));
    return 0;
  }
  GDESP_HD void operator()(Index i) const {
    const Index found = count(i);
    near[i] = found > 0 ? 1 : 0;
    rows_needed[i] = (found + 7) / 8;
  }
};

struct FillRows {
  WallSearch search;
  const Index* near;
  const Index* ordinal;
  const Index* first_row;
  Index* slot;
  Index* row_begin;
  WallRow* rows;
  WallLever* levers;  // null without bodies
  GrainRecord* records;
  const WallHistory* old_history;
  WallHistory* history;
  bool first;

  GDESP_HD static void clear(WallRow& row) {
    for (int l = 0; l < 8; ++l) {
      row.triangle[l] = 0;
      row.body[l] = 0;
      row.height[l] = far_height;
      for (int k = 0; k < 3; ++k) row.inside[k][l] = row.along[k][l] = 0.0f;
    }
    row.moving = 0;
  }
  GDESP_HD void put(Index index, int lane, Index t, const Vec3d& p) const {
    WallRow& row = rows[index];
    const TriangleCorners& c = search.mesh.corners[t];
    const std::int32_t body = search.mesh.frame[t].body;
    const Vec3d area = cross(c.b - c.a, c.c - c.a);
    const Vec3d n = (1.0 / norm(area)) * area;
    row.triangle[lane] = t;
    row.body[lane] = body;
    row.height[lane] = static_cast<float>(dot(n, p - c.a));
    const Vec3d corner[4] = {c.a, c.b, c.c, c.a};
    for (int k = 0; k < 3; ++k) {
      const Vec3d edge = corner[k + 1] - corner[k];
      const Vec3d along = (1.0 / norm(edge)) * edge;
      row.inside[k][lane] = static_cast<float>(dot(cross(n, along), p - corner[k]));
      row.along[k][lane] = static_cast<float>(dot(along, p - corner[k]));
    }
    if (body == 0) return;
    row.moving = 1;
    const Vec3d lever = p - search.poses[body].centre_initial;
    levers[index].x[lane] = static_cast<float>(lever.x);
    levers[index].y[lane] = static_cast<float>(lever.y);
    levers[index].z[lane] = static_cast<float>(lever.z);
  }
  GDESP_HD static bool over_face(const WallRow& row, int l) {
    return row.inside[0][l] >= 0.0f && row.inside[1][l] >= 0.0f && row.inside[2][l] >= 0.0f;
  }
  // At the start: a centre just behind a face came from its front, unless it touches the other side of a thin wall.
  GDESP_HD void adopt_side(Index begin, Index end, float radius, WallHistory& memory) const {
    for (Index r = begin; r < end; ++r) {
      for (int l = 0; l < 8; ++l) {
        const float height = rows[r].height[l];
        if (!(height <= 0.0f && height > -radius) || !over_face(rows[r], l)) continue;
        const Vec3f n = search.mesh.frame[rows[r].triangle[l]].n;
        bool other_side = false;
        for (Index s = begin; s < end && !other_side; ++s) {
          for (int m = 0; m < 8; ++m) {
            const float front = rows[s].height[m];
            other_side =
                other_side || (front > 0.0f && front < radius && rows[s].body[m] == rows[r].body[l] &&
                               over_face(rows[s], m) && dot(search.mesh.frame[rows[s].triangle[m]].n, n) < -0.5f);
          }
        }
        if (other_side || memory.count >= wall_contact_limit) continue;
        WallContact contact{};
        const double* m = search.poses[rows[r].body[l]].to_body;
        contact.n = static_cast<Vec3f>(Vec3d{m[0] * n.x + m[3] * n.y + m[6] * n.z, m[1] * n.x + m[4] * n.y + m[7] * n.z,
                                             m[2] * n.x + m[5] * n.y + m[8] * n.z});
        contact.body = rows[r].body[l];
        memory.contact[memory.count++] = contact;
      }
    }
  }

  GDESP_HD void operator()(Index i) const {
    GrainRecord& own = records[i];
    const std::int32_t old = own.wall;
    own.wall = -1;
    if (!near[i]) return;
    const Index w = ordinal[i], begin = first_row[i], end = first_row[i + 1];
    slot[w] = i;
    row_begin[w] = begin;
    for (Index r = begin; r < end; ++r) {
      clear(rows[r]);
      if (levers) levers[r] = WallLever{};
    }
    Index place = 0;
    search(i, search.list_reach(i), [&](Index t, const Vec3d& p, double) {
      put(begin + place / 8, place % 8, t, p);
      ++place;
    });
    WallHistory memory;
    if (old >= 0) memory = old_history[old];
    if (first) adopt_side(begin, end, own.radius, memory);
    history[w] = memory;
    own.wall = w;
  }
};

struct SetLast {
  Index* place;
  Index value;
  GDESP_HD void operator()(Index) const { *place = value; }
};

}  // namespace

template <class Exec>
WallContacts<Exec>::WallContacts(const Exec& exec, const Domain& domain, const WallMesh& mesh, double impulse_unit)
    : exec_(exec), domain_(domain), host_bodies_(mesh.body), impulse_unit_(impulse_unit), frame_(exec), corners_(exec),
      edge_(exec), vertex_(exec), smooth_(exec), ring_of_(exec), ring_(exec), node_(exec), body_(exec), listed_(exec),
      pose_(exec), slot_(exec), row_begin_(exec), rows_(exec), levers_(exec), gaps_(exec), history_(exec), force_(exec),
      impulse_(exec) {
  frame_.assign(mesh.frame);
  corners_.assign(mesh.corners);
  edge_.assign(mesh.edge);
  vertex_.assign(mesh.vertex);
  smooth_.assign(mesh.smooth);
  ring_of_.assign(mesh.ring_of);
  ring_.assign(mesh.ring);
  node_.assign(mesh.node);
  body_.assign(mesh.body);
  impulse_.assign(std::vector<std::int64_t>(6 * mesh.body.size(), 0));
}

template <class Exec>
double WallContacts<Exec>::body_reach(int body, const Vec3d& centre) const {
  const WallBody& b = host_bodies_[static_cast<std::size_t>(body)];
  return b.root < 0 ? 0.0 : b.reach + norm(b.middle - centre);
}

template <class Exec>
WallMeshView WallContacts<Exec>::mesh_view() const {
  return {frame_.data(),   corners_.data(), edge_.data(), vertex_.data(), smooth_.data(),
          ring_of_.data(), ring_.data(),    node_.data(), body_.data(),   static_cast<Index>(host_bodies_.size())};
}

template <class Exec>
void WallContacts<Exec>::build(const ClusterSet<Exec>& set, const Array<FixedPosition, Exec>& position,
                               GrainRecord* records, const std::vector<ListedPose>& poses, const WallReach& reach,
                               bool first, Array<GrainRecord, Exec>& room) {
  const Index slots = set.slots(), old_grains = static_cast<Index>(history_.size());
  const auto n = static_cast<std::size_t>(slots) + 1;
  listed_.assign(poses);
  // Four numbers a slot, then the contacts that were.
  static_assert(sizeof(WallHistory) % sizeof(Index) == 0 && alignof(WallHistory) == alignof(Index));
  Index* near = exec::room_for<Index>(room, 4 * n + history_.size() * (sizeof(WallHistory) / sizeof(Index)));
  Index *rows_needed = near + n, *ordinal = near + 2 * n, *first_row = near + 3 * n;
  WallHistory* old_history = reinterpret_cast<WallHistory*>(near + 4 * n);
  exec::parallel_for(exec_, "dem::wall_lists", old_grains, exec::CopyEach<WallHistory>{history_.data(), old_history});
  const WallSearch search{domain_, mesh_view(), listed_.data(), position.data(), records, reach.skin};
  exec::parallel_for(exec_, "dem::wall_lists", slots,
                     CountRows{search, reach.odometer, reach.look_ahead, reach.quiet_until, near, rows_needed});
  grains_ = exec::exclusive_scan(exec_, "dem::wall_lists", near, ordinal, slots);
  const Index rows = exec::exclusive_scan(exec_, "dem::wall_lists", rows_needed, first_row, slots);
  const auto grains = static_cast<std::size_t>(grains_);
  slot_.resize_discard(grains + 1);
  row_begin_.resize_discard(grains + 1);
  rows_.resize_discard(static_cast<std::size_t>(rows));
  if (bodies() > 1) levers_.resize_discard(static_cast<std::size_t>(rows));
  gaps_.resize_discard(static_cast<std::size_t>(rows));
  history_.resize_discard(grains);
  force_.resize_discard(grains);
  exec::parallel_for(exec_, "dem::wall_lists", slots,
                     FillRows{search, near, ordinal, first_row, slot_.data(), row_begin_.data(), rows_.data(),
                              levers_.data(), records, old_history, history_.data(), first});
  exec::parallel_for(exec_, "dem::wall_lists", 1, SetLast{row_begin_.data() + grains_, rows});
}

template <class Exec>
void WallContacts<Exec>::set_poses(const std::vector<BodyPose>& poses) {
  if (bodies() > 1 || pose_.empty()) pose_.assign(poses);  // walls at rest stay where they are
}

template <class Exec>
template <class Law>
void WallContacts<Exec>::step(const ContactLaws<Law>& laws, const WallMotion& motion, int sub_step,
                              const exec::Gate& gate, exec::Largest* measure) {
  const Index set = bodies() > 1 ? sub_step * static_cast<Index>(bodies()) : 0;
  run_wall_step(exec_, laws,
                WallStepView{mesh_view(), position_unit(domain_), motion.grains, slot_.data(), row_begin_.data(),
                             rows_.data(), levers_.data(), gaps_.data(), pose_.data() + set, history_.data(),
                             force_.data(), impulse_.data(), impulse_unit_, motion.inertia_factor, motion.half},
                grains_, gate, measure);
}

template <class Exec>
std::vector<BodyImpulse> WallContacts<Exec>::take_impulses() {
  std::vector<std::int64_t> units = impulse_.to_host();
  std::vector<BodyImpulse> impulses;
  for (std::size_t b = 1; b < host_bodies_.size(); ++b) {
    const auto value = [&](std::size_t k) { return impulse_unit_ * static_cast<double>(units[6 * b + k]); };
    impulses.push_back({{value(0), value(1), value(2)}, {value(3), value(4), value(5)}});
  }
  impulse_.fill_bytes(0);
  return impulses;
}

template class WallContacts<exec::CompiledBackend>;
template void WallContacts<exec::CompiledBackend>::step(const ContactLaws<HertzMindlin>&, const WallMotion&, int,
                                                        const exec::Gate&, exec::Largest*);
template void WallContacts<exec::CompiledBackend>::step(const ContactLaws<LinearSpringDashpot>&, const WallMotion&, int,
                                                        const exec::Gate&, exec::Largest*);

}  // namespace gdesp::dem
