// SPDX-License-Identifier: GPL-3.0-or-later
// Grains near walls: which triangles each may touch, and the contacts that go on. Only grains near walls appear here.
#pragma once

#include "dem/body_motion.hpp"
#include "dem/wall_views.hpp"

namespace gdesp::dem {

/// Body axes and place, for listing.
struct ListedPose {
  double to_body[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< R^T
  Vec3d centre, centre_initial;                     ///< m
  std::int32_t present = 1, reserved = 0;
};

/// The grains as a sub-step finds them.
struct WallMotion {
  GrainPlaces grains;
  HalfSteps half;
  float inertia_factor;  ///< I / (m R^2)
};

/// How far to look for walls. The odometer is the way that no grain and body together have exceeded since the start;
/// quiet_until (by slot) is its reading before which a grain touches no wall.
struct WallReach {
  float skin = 0.0f;             ///< m
  double odometer = 0.0;         ///< m
  double look_ahead = 0.0;       ///< m, beyond the skin
  float* quiet_until = nullptr;  ///< m
};

template <class Exec>
class WallContacts {
 public:
  WallContacts() = default;
  WallContacts(const Exec& exec, const Domain& domain, const WallMesh& mesh, double impulse_unit);

  bool empty() const { return frame_.empty(); }
  Index grains() const { return grains_; }
  int bodies() const { return static_cast<int>(host_bodies_.size()); }  ///< with the walls at rest as number 0
  double body_reach(int body, const Vec3d& centre) const;               ///< m, farthest corner from the centre

  /// Lists the triangles within radius + reach.skin of each grain that may move, and takes over the contacts of grains that
  /// had some (GrainRecord::wall names their old number; it becomes the new one). `poses`: by body number.
  /// `first`: grains whose centre lies behind a face, less than a radius deep, count as come from its front. What is in
  /// `room` is lost.
  void build(const ClusterSet<Exec>& set, const Array<FixedPosition, Exec>& position, GrainRecord* records,
             const std::vector<ListedPose>& poses, const WallReach& reach, bool first, Array<GrainRecord, Exec>& room);
  /// Poses for the calls of step() that follow: by body number, one such set a sub-step.
  void set_poses(const std::vector<BodyPose>& poses);
  /// Forces at time n, with poses of set `sub_step`, unless the gate is closed.
  template <class Law>
  void step(const ContactLaws<Law>& laws, const WallMotion& motion, int sub_step, const exec::Gate& gate,
            exec::Largest* measure);
  const WallForce* forces() const { return force_.data(); }

  /// Impulses on bodies 1, 2, ... since the last call.
  std::vector<BodyImpulse> take_impulses();
  Array<std::int64_t, Exec>& impulse_units() { return impulse_; }
  Array<WallHistory, Exec>& history() { return history_; }
  const Array<WallHistory, Exec>& history() const { return history_; }

 private:
  WallMeshView mesh_view() const;

  Exec exec_{};
  Domain domain_;
  std::vector<WallBody> host_bodies_;
  double impulse_unit_ = 1.0;
  Index grains_ = 0;
  Array<TriangleFrame, Exec> frame_;
  Array<TriangleCorners, Exec> corners_;
  Array<EdgeSide, Exec> edge_;
  Array<Vec3<std::int32_t>, Exec> vertex_;
  Array<std::int32_t, Exec> smooth_;
  Array<VertexRing, Exec> ring_of_;
  Array<Vec3f, Exec> ring_;
  Array<WallNode, Exec> node_;
  Array<WallBody, Exec> body_;
  Array<ListedPose, Exec> listed_;
  Array<BodyPose, Exec> pose_;
  Array<Index, Exec> slot_, row_begin_;
  Array<WallRow, Exec> rows_;
  Array<WallLever, Exec> levers_;
  Array<WallGap, Exec> gaps_;
  Array<WallHistory, Exec> history_;
  Array<WallForce, Exec> force_;
  Array<std::int64_t, Exec> impulse_;
};

/// Runs the pass over grains near walls.
template <class Exec, class Law>
void run_wall_step(const Exec& exec, const ContactLaws<Law>& laws, const WallStepView& view, Index grains,
                   const exec::Gate& gate, exec::Largest* measure);

}  // namespace gdesp::dem
