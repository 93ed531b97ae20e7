// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of walls on grains at one moment: eight lanes look for the nearest points of the triangles in reach; then one
// lane decides which of them are contacts and adds their forces.
//
// One contact per feature: the nearest point of a triangle counts only when it is a nearest point of the surface
// around it (it must not lie on an edge or vertex whose other triangles come nearer), and contacts whose normals
// differ little share their stiffness, so that a rolling grain does not feel seams.
#include "dem/wall_contacts.hpp"

namespace gdesp::dem {
namespace {

constexpr float full_weight_turn = 0.0340742f;  // 1 - cos 15 deg: from here on two contacts count fully
constexpr float same_contact = 0.98f;           // cosine between the normals of one contact in successive steps
constexpr float same_side = 0.2f;               // cosine with a remembered normal for a centre behind the face
constexpr float seam_tolerance = 1.0e-4f;       // of a radius

struct Touch {
  Vec3f n;           // world
  float overlap;     // m
  Vec3f centre_arm;  // m, grain centre - body centre, world
  std::int32_t body;
  bool smooth;
};

template <class Law>
struct WallStep {
  ContactLaws<Law> laws;
  WallStepView v;

  // World from body axes.
  GDESP_HD static Vec3f to_world(const BodyPose& pose, const Vec3f& b) {
    const float* m = pose.to_body;
    return {m[0] * b.x + m[3] * b.y + m[6] * b.z, m[1] * b.x + m[4] * b.y + m[7] * b.z,
            m[2] * b.x + m[5] * b.y + m[8] * b.z};
  }
  template <class R>
  GDESP_HD static Vec3<R> apply(const R* m, const Vec3<R>& a) {
    return {m[0] * a.x + m[1] * a.y + m[2] * a.z, m[3] * a.x + m[4] * a.y + m[5] * a.z,
            m[6] * a.x + m[7] * a.y + m[8] * a.z};
  }

  // Displacement of the grain since listing, against each lane's body, body axes.
  template <class Lanes>
  GDESP_HD Vec3<typename Lanes::Real> displacement(const Vec3f& u, Index index, const Lanes& lanes) const {
    using R = typename Lanes::Real;
    const Vec3<R> world{R(u.x), R(u.y), R(u.z)};
    const WallRow& row = v.rows[index];
    if (!row.moving) return world;
    constexpr int pose_floats = sizeof(BodyPose) / sizeof(float);
    const float* poses = reinterpret_cast<const float*>(v.pose);
    const auto base = lanes.scaled(lanes.load(row.body), pose_floats);
    R to_body[9], turned[9], shift[3];
    for (int k = 0; k < 9; ++k) to_body[k] = lanes.gather(poses + k, base);
    for (int k = 0; k < 9; ++k) turned[k] = lanes.gather(poses + 9 + k, base);
    for (int k = 0; k < 3; ++k) shift[k] = lanes.gather(poses + 18 + k, base);
    const WallLever& levers = v.levers[index];
    const Vec3<R> lever{lanes.load(levers.x), lanes.load(levers.y), lanes.load(levers.z)};
    return apply(to_body, Vec3<R>{world.x - shift[0], world.y - shift[1], world.z - shift[2]}) + apply(turned, lever);
  }

  template <class R>
  struct Nearest {
    R distance2, inside, beyond, kind;  // in the plane; offset along the edge beyond its ends
    Vec3<R> m;
  };

  // One edge as the grain's centre sees it: inside of it, along it.
  template <class R>
  struct Edge {
    R inside, along, length;
    Vec3<R> m;
  };
  // Takes edge k when it is nearer than what was found.
  template <class R>
  GDESP_HD static void try_edge(int k, const Edge<R>& edge, Nearest<R>& best) {
    using real::max;
    using real::min;
    using real::select;
    const R &inside = edge.inside, &along = edge.along, &length = edge.length;
    const Vec3<R>& m = edge.m;
    const R beyond = along - max(R(0.0f), min(along, length));
    const R distance2 = inside * inside + beyond * beyond;
    const auto nearer = distance2 < best.distance2;
    const R start(5.0f + static_cast<float>(k)), end(5.0f + static_cast<float>((k + 1) % 3));
    const R kind = select(beyond < R(0.0f), start, select(beyond > R(0.0f), end, R(2.0f + static_cast<float>(k))));
    best.distance2 = select(nearer, distance2, best.distance2);
    best.inside = select(nearer, inside, best.inside);
    best.beyond = select(nearer, beyond, best.beyond);
    best.kind = select(nearer, kind, best.kind);
    best.m = {select(nearer, m.x, best.m.x), select(nearer, m.y, best.m.y), select(nearer, m.z, best.m.z)};
  }

  // True when some triangle is in reach.
  template <class Lanes>
  GDESP_HD bool find_gaps(const Vec3f& displaced, float radius, Index index, const Lanes& lanes) const {
    using R = typename Lanes::Real;
    using real::min;
    using real::select;
    const WallRow& row = v.rows[index];
    const auto t = lanes.load(row.triangle);
    const float* frames = reinterpret_cast<const float*>(v.mesh.frame);
    R q0[4], q1[4], q2[4], q3[4];
    lanes.gather4(frames, 16, t, q0);
    lanes.gather4(frames + 4, 16, t, q1);
    lanes.gather4(frames + 8, 16, t, q2);
    lanes.gather4(frames + 12, 16, t, q3);
    const Vec3<R> u = displacement(displaced, index, lanes);
    const Vec3<R> n{q0[0], q0[1], q0[2]}, m0{q1[0], q1[1], q1[2]}, m1{q2[0], q2[1], q2[2]}, m2{q3[0], q3[1], q3[2]};
    const R height = dot(n, u) + lanes.load(row.height);
    const R edge0 = dot(m0, u) + lanes.load(row.inside[0]), edge1 = dot(m1, u) + lanes.load(row.inside[1]);
    const R edge2 = dot(m2, u) + lanes.load(row.inside[2]);
    Nearest<R> best{R(1.0e30f), R(0.0f), R(0.0f), R(1.0f), m0};
    try_edge(0, Edge<R>{edge0, dot(cross(m0, n), u) + lanes.load(row.along[0]), q0[3], m0}, best);
    try_edge(1, Edge<R>{edge1, dot(cross(m1, n), u) + lanes.load(row.along[1]), q1[3], m1}, best);
    try_edge(2, Edge<R>{edge2, dot(cross(m2, n), u) + lanes.load(row.along[2]), q2[3], m2}, best);
    const R zero(0.0f);
    const auto outside = min(edge0, min(edge1, edge2)) < zero;
    const R in = select(outside, best.inside, zero), beyond = select(outside, best.beyond, zero);
    const R distance2 = height * height + in * in + beyond * beyond;
    const auto reached = distance2 < R(radius * radius);
    WallGap& gap = v.gaps[index];
    if (!lanes.any(reached)) {
      lanes.store(gap.feature, lanes.truncate(zero));
      return false;
    }
    const R kind = select(reached, select(outside, best.kind, R(1.0f)), zero);
    const Vec3<R> along = cross(best.m, n);
    lanes.store(gap.x, height * n.x + in * best.m.x + beyond * along.x);
    lanes.store(gap.y, height * n.y + in * best.m.y + beyond * along.y);
    lanes.store(gap.z, height * n.z + in * best.m.z + beyond * along.z);
    lanes.store(gap.height, height);
    lanes.store(gap.feature, lanes.truncate(kind));
    return true;
  }

  // A centre behind a face belongs to the front when it came from there.
  GDESP_HD static bool came_from_front(const WallHistory& history, std::int32_t body, const Vec3f& n) {
    for (int k = 0; k < history.count; ++k) {
      if (history.contact[k].body == body && dot(history.contact[k].n, n) > same_side) return true;
    }
    return false;
  }
  // Whether the nearest point is one of the whole surface, not only of its triangle.
  GDESP_HD bool nearest_of_surface(Index triangle, int feature, const Vec3f& gap, float tolerance) const {
    if (feature < 5) {
      const EdgeSide& side = v.mesh.edge[3 * triangle + feature - 2];
      return side.open || (dot(gap, side.neighbour_inside) <= tolerance && dot(gap, side.outward) > 0.0f);
    }
    const VertexRing& ring = v.mesh.ring_of[v.mesh.vertex[triangle][feature - 5]];
    if (!ring.open && !(dot(gap, ring.outward) > 0.0f)) return false;
    for (Index k = ring.begin; k < ring.end; ++k) {
      if (dot(gap, v.mesh.ring[k]) > tolerance) return false;
    }
    return true;
  }
  GDESP_HD bool make_touch(Index r, int lane, float radius, const Vec3f& displaced, const WallHistory& history,
                           Touch& touch) const {
    const WallRow& row = v.rows[r];
    const WallGap& gaps = v.gaps[r];
    const int feature = gaps.feature[lane];
    const std::int32_t body = row.body[lane];
    const BodyPose& pose = v.pose[body];
    if (feature == 0 || !pose.present) return false;
    const Vec3f gap{gaps.x[lane], gaps.y[lane], gaps.z[lane]};
    Vec3f n = v.mesh.frame[row.triangle[lane]].n;
    float distance = gaps.height[lane];
    if (feature > 1) {
      if (!nearest_of_surface(row.triangle[lane], feature, gap, seam_tolerance * radius)) return false;
      distance = norm(gap);
      if (!(distance > 1.0e-6f * radius)) return false;
      n = (1.0f / distance) * gap;
    }
    if (!(distance < radius)) return false;  // the root is rounded otherwise than its square was
    touch.n = body == 0 ? n : to_world(pose, n);
    if (distance <= 0.0f && !came_from_front(history, body, touch.n)) return false;
    touch.overlap = radius - distance;
    touch.body = body;
    touch.smooth = v.mesh.smooth[row.triangle[lane]] != 0;
    if (body != 0) {
      const WallLever& levers = v.levers[r];
      const Vec3f lever{levers.x[lane], levers.y[lane], levers.z[lane]};
      touch.centre_arm =
          to_world(pose, lever + apply(pose.to_body, displaced - pose.shift) + apply(pose.turned, lever));
    }
    return true;
  }

  // Deepest first; of more than the limit the shallowest are left out.
  GDESP_HD static void insert(const Touch& touch, Touch* list, int& count) {
    int place = count;
    while (place > 0 && list[place - 1].overlap < touch.overlap) --place;
    if (place >= wall_contact_limit) return;
    if (count < wall_contact_limit) ++count;
    for (int k = count - 1; k > place; --k) list[k] = list[k - 1];
    list[place] = touch;
  }
  GDESP_HD static float weight(const Touch* list, int k) {
    float share = 1.0f;
    for (int m = 0; m < k; ++m) {
      share = real::min(share, real::max(0.0f, 1.0f - dot(list[k].n, list[m].n)) * (1.0f / full_weight_turn));
    }
    return share;
  }
  // The remembered contact that goes on in this one; each is taken once.
  GDESP_HD static WallContact recall(const Touch& touch, const WallHistory& old, unsigned& taken) {
    int best = -1;
    float cosine = same_contact;
    for (int k = 0; k < old.count; ++k) {
      const float c = dot(old.contact[k].n, touch.n);
      if (old.contact[k].body == touch.body && c > cosine && !(taken & (1u << k))) {
        best = k;
        cosine = c;
      }
    }
    WallContact contact{};
    if (best >= 0) {
      taken |= 1u << best;
      contact = old.contact[best];
    }
    contact.n = touch.n;
    contact.body = touch.body;
    return contact;
  }

  GDESP_HD void add_contact(const GrainRecord& own, const Touch& touch, float share, WallContact& memory,
                            WallForce& sum) const {
    const BodyPose& pose = v.pose[touch.body];
    const float arm = real::max(own.radius - touch.overlap, 0.0f);
    const Vec3f point = touch.centre_arm - arm * touch.n;  // from the body's centre
    const Vec3f surface = (1.0f / own.radius) * Vec3f{own.sx, own.sy, own.sz};
    ContactGeometry<float> g;
    g.n = touch.n;
    g.overlap = touch.overlap;
    g.radius = own.radius;
    g.mass = own.mass;
    g.velocity = Vec3f{own.vx, own.vy, own.vz} - arm * cross(surface, touch.n);
    if (touch.body != 0) g.velocity -= pose.velocity + cross(pose.spin, point);
    ContactLaws<Law> felt = laws;
    if (touch.smooth) felt.friction = felt.rolling_friction = 0.0f;
    const ContactForce<float> c = contact_force(felt, g, v.half, memory.tangential);
    Vec3f rolling{};
    if (felt.rolling_friction > 0.0f) {
      const float inertia = (1.0f + v.inertia_factor) * own.mass * own.radius * own.radius;
      const RollingMotion<float> motion{touch.n,        surface - pose.spin, own.radius,  inertia,
                                        c.normal_force, v.half.before,       v.half.after};
      rolling = rolling_torque(felt.rolling_friction, c.normal_stiffness, motion, memory.rolling);
    }
    sum.force += share * c.force;
    sum.torque += share * (arm * cross(c.force, touch.n) + rolling);
    if (touch.body != 0) give_to_body(touch.body, -share * c.force, cross(point, -share * c.force) - share * rolling);
  }
  GDESP_HD void give_to_body(std::int32_t body, const Vec3f& force, const Vec3f& torque) const {
    const double scale = static_cast<double>(v.half.before + v.half.after) / v.impulse_unit;
    for (int axis = 0; axis < 3; ++axis) {
      exec::add_units(v.impulse + 6 * body + axis, static_cast<std::int64_t>(::llrint(scale * force[axis])));
      exec::add_units(v.impulse + 6 * body + 3 + axis, static_cast<std::int64_t>(::llrint(scale * torque[axis])));
    }
  }

  GDESP_HD float resolve(Index w, const GrainRecord& own, const Vec3f& displaced) const {
    const WallHistory old = v.history[w];
    Touch list[wall_contact_limit];
    int count = 0;
    for (Index r = v.row_begin[w]; r < v.row_begin[w + 1]; ++r) {
      for (int lane = 0; lane < 8; ++lane) {
        Touch touch{};
        if (make_touch(r, lane, own.radius, displaced, old, touch)) insert(touch, list, count);
      }
    }
    WallForce sum{};
    WallHistory next;
    next.count = 0;
    unsigned taken = 0;
    for (int k = 0; k < count; ++k) {
      const float share = weight(list, k);
      if (share < 0.01f) continue;
      WallContact memory = recall(list[k], old, taken);
      add_contact(own, list[k], real::min(share, 1.0f), memory, sum);
      next.contact[next.count++] = memory;
    }
    v.force[w] = sum;
    if (next.count > 0 || old.count > 0) v.history[w] = next;
    return count > 0 ? list[0].overlap / (2.0f * own.radius) : 0.0f;
  }

  template <class Lanes>
  GDESP_HD exec::Largest operator()(Index w, const Lanes& lanes) const {
    const Index i = v.slot[w];
    const GrainRecord& own = v.grains.record[i];
    const Vec3<std::int32_t> start = v.grains.listed_bits(i);
    const Vec3f displaced{static_cast<float>(fraction_difference(own.x, start.x)) * v.unit.metres.x,
                          static_cast<float>(fraction_difference(own.y, start.y)) * v.unit.metres.y,
                          static_cast<float>(fraction_difference(own.z, start.z)) * v.unit.metres.z};
    bool reached = false;
    for (Index r = v.row_begin[w]; r < v.row_begin[w + 1]; ++r) {
      reached = find_gaps(displaced, own.radius, r, lanes) || reached;
    }
    lanes.share_memory();
    float overlap = 0.0f;
    if (lanes.leader()) {
      if (reached) {
        overlap = resolve(w, own, displaced);
      } else {
        v.force[w] = WallForce{};
        v.history[w].count = 0;
      }
    }
    return {{0.0f, 0.0f, overlap, 0.0f}};
  }
};

}  // namespace

template <class Exec, class Law>
void run_wall_step(const Exec& exec, const ContactLaws<Law>& laws, const WallStepView& view, Index grains,
                   const exec::Gate& gate, exec::Largest* measure) {
  exec::row_pass(exec, "dem::walls", grains, WallStep<Law>{laws, view}, gate, measure);
}

template void run_wall_step(const exec::CompiledBackend&, const ContactLaws<HertzMindlin>&, const WallStepView&, Index,
                            const exec::Gate&, exec::Largest*);
template void run_wall_step(const exec::CompiledBackend&, const ContactLaws<LinearSpringDashpot>&, const WallStepView&,
                            Index, const exec::Gate&, exec::Largest*);

}  // namespace gdesp::dem
