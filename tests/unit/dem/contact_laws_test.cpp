// SPDX-License-Identifier: GPL-3.0-or-later
// The laws of contact against numbers worked out by hand (double precision, outside the code), their symmetry and
// their limits. Pair of the hand values: R = 10 and 20 mm, m = 10 and 80 g, E = 1e7 Pa, nu = 0.3, e = 0.5,
// overlap 0.1 mm: R* = 6.6667 mm, m* = 8.8889 g, E* = 5.494505e6 Pa, G* = 1.131222e6 Pa.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "dem/contact_parameters.hpp"
#include "dem/grain_motion.hpp"
#include "dem/time_step_limits.hpp"
#include "exec/lanes.hpp"

namespace gdesp::dem {
namespace {

constexpr float hand_radius = 0.0066666667f, hand_mass = 0.0088888889f, hand_overlap = 1.0e-4f;

HertzMindlin hand_law(double restitution = 0.5) {
  return make_hertz_mindlin(effective_modulus(1e7, 0.3, 1e7, 0.3), effective_shear_modulus(1e7, 0.3, 1e7, 0.3),
                            restitution);
}

// @eq dem.hertz.normal
TEST(HertzNormal, HandValue) {
  EXPECT_NEAR(effective_modulus(1e7, 0.3, 1e7, 0.3), 5494505.4945, 0.01);
  const auto c = hand_law()(hand_overlap, hand_radius, hand_mass);
  EXPECT_NEAR(c.elastic_force, 0.598165993, 1e-6);  // E* = E/(1 - nu^2) would give 1.196332
  EXPECT_NEAR(c.normal_stiffness, 8972.4899, 0.01);
}

TEST(HertzNormal, RigidPartnerDoublesTheModulus) {
  const double rigid = effective_modulus(1e7, 0.3, std::numeric_limits<double>::infinity(), 0.3);
  EXPECT_NEAR(rigid, 2.0 * 5494505.4945, 0.02);
}

TEST(HertzNormal, ForceVanishesWithOverlapAndGrowsAsItsThreeHalves) {
  const HertzMindlin law = hand_law();
  EXPECT_LT(law(1.0e-12f, hand_radius, hand_mass).elastic_force, 1.0e-11f);
  const float ratio =
      law(4.0e-4f, hand_radius, hand_mass).elastic_force / law(1.0e-4f, hand_radius, hand_mass).elastic_force;
  EXPECT_NEAR(ratio, 8.0f, 1e-5f);
}

TEST(HertzNormal, StiffnessIsTheSlopeOfTheForce) {
  const HertzMindlin law = hand_law();
  const float step = 1.0e-6f;
  const float slope = (law(hand_overlap + step, hand_radius, hand_mass).elastic_force -
                       law(hand_overlap - step, hand_radius, hand_mass).elastic_force) /
                      (2.0f * step);
  EXPECT_NEAR(slope / law(hand_overlap, hand_radius, hand_mass).normal_stiffness, 1.0f, 2e-4f);
}

// @eq dem.hertz.damping
TEST(HertzDamping, HandValueAndElasticLimit) {
  EXPECT_NEAR(damping_ratio(0.5), 0.2154537620, 1e-9);
  EXPECT_NEAR(hand_law()(hand_overlap, hand_radius, hand_mass).normal_damping, 3.51296386, 1e-5);
  EXPECT_EQ(hand_law(1.0)(hand_overlap, hand_radius, hand_mass).normal_damping, 0.0f);
}

// @eq dem.mindlin.tangential
TEST(MindlinTangential, HandValue) {
  EXPECT_NEAR(effective_shear_modulus(1e7, 0.3, 1e7, 0.3), 1131221.7195, 0.01);
  const auto c = hand_law()(hand_overlap, hand_radius, hand_mass);
  EXPECT_NEAR(c.tangential_stiffness, 7389.10933, 0.01);
  EXPECT_NEAR(c.tangential_damping, 3.18796276, 1e-5);
}

// Full slip of a pressed contact happens at displacement mu F/S_t: 8 G*/(2 E*) = 2 (1 - nu)/(2 - nu) = 0.8235.
TEST(MindlinTangential, RatioOfStiffnesses) {
  const auto c = hand_law()(hand_overlap, hand_radius, hand_mass);
  EXPECT_NEAR(c.tangential_stiffness / c.normal_stiffness, 2.0 * 0.7 / 1.7, 1e-5);
}

// @eq dem.linear.normal
// @eq dem.linear.damping
TEST(LinearSpringDashpot, HandValues) {
  const LinearSpringDashpot law = make_linear_spring_dashpot(1000.0, 2.0 / 7.0, 0.9);
  const auto c = law(hand_overlap, hand_radius, hand_mass);
  EXPECT_NEAR(c.elastic_force, 0.1, 1e-7);
  EXPECT_NEAR(c.normal_damping, 0.1998654152, 1e-6);
  EXPECT_NEAR(c.tangential_stiffness, 285.714286, 1e-3);
  EXPECT_NEAR(c.tangential_damping / c.normal_damping, std::sqrt(2.0 / 7.0), 1e-5);
}

ContactCoefficients<float> springs() { return {10.0f, 1000.0f, 0.0f, 500.0f, 0.0f}; }

// @eq dem.friction.coulomb
TEST(CoulombFriction, SticksWithSpringAndSlipsAtTheCap) {
  Vec3f history{};
  ContactMotion<float> m{{0, 0, 1}, {0.1f, 0, 0}, 1.0f, 5.0f, 0.005f, 0.005f};
  // Middle of the first step: 500 N/m * 0.1 m/s * 0.005 s; stored half a step later.
  Vec3f f = tangential_force(springs(), m, history);
  EXPECT_NEAR(f.x, -0.25f, 1e-6f);
  EXPECT_NEAR(history.x, -0.5f, 1e-6f);
  for (int k = 0; k < 20; ++k) f = tangential_force(springs(), m, history);
  EXPECT_NEAR(f.x, -5.0f, 1e-5f);
  EXPECT_NEAR(norm(f), 5.0f, 1e-5f);
  // The way back begins at once: the spring remembers the cap, not the whole way.
  m.v_t = {-0.1f, 0, 0};
  f = tangential_force(springs(), m, history);
  EXPECT_GT(f.x, -5.3f);
  f = tangential_force(springs(), m, history);
  EXPECT_GT(f.x, -4.6f);
}

TEST(CoulombFriction, OpeningContactLosesForceWithItsStiffness) {
  Vec3f history{4.0f, 0, 0};
  const ContactMotion<float> m{{0, 0, 1}, {}, 0.5f, 100.0f, 0.0f, 0.0f};
  EXPECT_NEAR(tangential_force(springs(), m, history).x, 2.0f, 1e-6f);
  const HertzMindlin law = hand_law();
  // One percent less overlap: S_t falls by half a percent.
  EXPECT_NEAR(law.unloading(0.99e-4f, 1.0e-3f, 1.0e-3f), std::sqrt(0.99), 2e-4);
  EXPECT_EQ(law.unloading(1.0e-4f, 0.0f, 1.0e-3f), 1.0f);
}

// Pressed, sheared, opened to half the overlap, sheared back, pressed again: the work of the tangential force, in J. Normal work cancels over
// the cycle. `knows_opening`: with the law's q, else with 1.
double work_of_a_cycle(bool knows_opening) {
  const HertzMindlin law = hand_law(1.0);
  const int steps = 1000;
  const float dt = 1.0e-6f, way = 1.0e-5f, opened = 0.5f * hand_overlap;
  const float shear = way / (steps * dt), opening = (hand_overlap - opened) / (steps * dt);
  float overlap = hand_overlap;
  Vec3f history{};
  double work = 0.0;
  const auto move = [&](float v_t, float v_apart) {
    for (int k = 0; k < steps; ++k) {
      overlap -= v_apart * dt;
      const float q = knows_opening && v_apart > 0.0f ? law.unloading(overlap, v_apart, dt) : 1.0f;
      const ContactMotion<float> m{{0, 0, 1}, {v_t, 0, 0}, q, 1.0e9f, 0.5f * dt, 0.5f * dt};
      work += static_cast<double>(tangential_force(law(overlap, hand_radius, hand_mass), m, history).x * v_t * dt);
    }
  };
  move(shear, 0.0f);
  move(0.0f, opening);
  move(-shear, 0.0f);
  move(0.0f, -opening);
  return work;
}

// Of the elastic energy of the shear, 8 G* a way^2/2, a share (1 - 1/sqrt 2) is lost with the stiffness; a law without q would
// make as much.
TEST(CoulombFriction, ACycleOfShearAndOpeningMakesNoEnergy) {
  const double stored = 0.5 * 8.0 * 1.131222e6 * std::sqrt(0.0066666667 * 1.0e-4) * 1.0e-10,
               lost = (1.0 - std::sqrt(0.5)) * stored;
  EXPECT_NEAR(work_of_a_cycle(true), -lost, 0.01 * lost);
  EXPECT_NEAR(work_of_a_cycle(false), lost, 0.01 * lost);
}

TEST(CoulombFriction, HistoryTurnsIntoThePlaneOfContact) {
  Vec3f history{1.0f, 0, 2.0f};
  const ContactMotion<float> m{{0, 0, 1}, {}, 1.0f, 100.0f, 0.0f, 0.0f};
  const Vec3f f = tangential_force(springs(), m, history);
  EXPECT_EQ(f.z, 0.0f);
  EXPECT_EQ(f.x, 1.0f);
}

// @eq dem.cohesion.dmt
TEST(Cohesion, HandValue) { EXPECT_NEAR(dmt_pull(0.05f, hand_radius), 2.0943951e-3f, 1e-8f); }

// @eq dem.rolling.elastic_plastic
TEST(RollingResistance, SpringThenConstantTorque) {
  Vec3f history{};
  RollingMotion<float> m{{0, 0, 1}, {0, 2.0f, 3.0f}, hand_radius, 0.0f, 0.6f, 0.0f, 0.0f};
  m.half_before = 1.0e-5f;
  // k_r = 2.25 * 8972.49 * (0.1 * R*)^2 = 8.97249e-3 N m; inertia 0: no damping. Only the part in the plane rolls.
  Vec3f t = rolling_torque(0.1f, 8972.49f, m, history);
  EXPECT_NEAR(t.y, -8.97249e-3f * 2.0f * 1.0e-5f, 1e-11f);
  EXPECT_EQ(t.z, 0.0f);
  m.half_after = m.half_before = 1.0e-3f;
  for (int k = 0; k < 100; ++k) t = rolling_torque(0.1f, 8972.49f, m, history);
  EXPECT_NEAR(t.y, -0.1f * hand_radius * 0.6f, 1e-8f);
}

// @eq dem.damping.limit
TEST(ContactForce, DampingTakesALimitedShareOfTheVelocityInAStep) {
  const ContactLaws<HertzMindlin> laws{hand_law(0.5), 100.0f};
  const auto damping = [&](float step) {  // N s/m: normal, tangential
    const HalfSteps half{0.5f * step, 0.5f * step};
    const auto force_at = [&](float v_t, float v_n) {
      Vec3f history{};
      return contact_force(laws, ContactGeometry<float>{{0, 0, 1}, hand_overlap, hand_radius, hand_mass, {v_t, 0, v_n}},
                           half, history)
          .force;
    };
    const float spring = laws.law(hand_overlap, hand_radius, hand_mass).tangential_stiffness * half.before;
    return Vec3f{-force_at(0.001f, 0.0f).x / 0.001f - spring, 0.0f,
                 (force_at(0.0f, -0.01f).z - force_at(0.0f, 0.0f).z) / 0.01f};
  };
  const auto c = laws.law(hand_overlap, hand_radius, hand_mass);
  EXPECT_NEAR(damping(1.0e-5f).x, c.tangential_damping, 2e-3f * c.tangential_damping);
  EXPECT_NEAR(damping(1.0e-5f).z, c.normal_damping, 2e-3f * c.normal_damping);
  EXPECT_NEAR(damping(1.0e-3f).x, 0.06f * hand_mass / 1.0e-3f, 2e-3f);
  EXPECT_NEAR(damping(1.0e-3f).z, 0.2f * hand_mass / 1.0e-3f, 2e-3f);
}

// Both copies of a contact must agree to the last bit, in every lane and with fused multiply-add.
TEST(ContactForce, ExchangingGrainsChangesOnlySigns) {
  const ContactLaws<HertzMindlin> laws{hand_law(0.3), 0.4f, 0.1f, 0.01f};
  const HalfSteps half{1.3e-5f, 1.7e-5f};
  using exec::Float8;
  Vec3<Float8> n, v, f;
  Float8 overlap, radius, mass;
  for (int k = 0; k < 8; ++k) {
    const float angle = 0.7f * static_cast<float>(k);
    n.x.v[k] = 0.6f * std::cos(angle);
    n.y.v[k] = 0.6f * std::sin(angle);
    n.z.v[k] = 0.8f;
    v.x.v[k] = 0.31f * static_cast<float>(k) - 1.0f;
    v.y.v[k] = 0.17f;
    v.z.v[k] = -0.9f + 0.3f * static_cast<float>(k);
    f.x.v[k] = 0.03f;
    f.y.v[k] = -0.021f * static_cast<float>(k);
    f.z.v[k] = 0.007f;
    overlap.v[k] = 1.0e-5f * static_cast<float>(k + 1);
    radius.v[k] = hand_radius;
    mass.v[k] = hand_mass;
  }
  Vec3<Float8> history_i = f, history_j{-f.x, -f.y, -f.z};
  const ContactGeometry<Float8> g_i{n, overlap, radius, mass, v};
  const ContactGeometry<Float8> g_j{{-n.x, -n.y, -n.z}, overlap, radius, mass, {-v.x, -v.y, -v.z}};
  const auto c_i = contact_force(laws, g_i, half, history_i);
  const auto c_j = contact_force(laws, g_j, half, history_j);
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(c_i.force.x.v[k], -c_j.force.x.v[k]);
    EXPECT_EQ(c_i.force.y.v[k], -c_j.force.y.v[k]);
    EXPECT_EQ(c_i.force.z.v[k], -c_j.force.z.v[k]);
    EXPECT_EQ(history_i.x.v[k], -history_j.x.v[k]);
    EXPECT_EQ(history_i.y.v[k], -history_j.y.v[k]);
    EXPECT_EQ(history_i.z.v[k], -history_j.z.v[k]);
    EXPECT_NE(c_i.force.z.v[k], 0.0f);
  }
}

// @eq dem.time_step.rayleigh
// @eq dem.time_step.linear
TEST(TimeStepLimits, HandValues) {
  EXPECT_NEAR(rayleigh_time(0.004545, 2650.0, 2.0e8, 0.3), 9.054988e-5, 1e-10);
  EXPECT_NEAR(linear_contact_time(1000.0, 0.0088888889, 0.9), 9.3716856e-3, 1e-9);
}

// @eq dem.motion.drag
TEST(SemiImplicitDrag, RelaxesWithoutOvershoot) {
  // k b = 3, 1/M = 0.5, 1/m_f = 0.5: J = 3 * 8/(1 + 3).
  EXPECT_NEAR(drag_impulse({2.0f, 0.5f, 0.5f}, 1.5f, 8.0f), 6.0f, 1e-5f);
  // Whatever the step, the slip ends no lower than zero: J (1/M + 1/m_f) = slip at most.
  EXPECT_NEAR(drag_impulse({2.0f, 0.5f, 0.5f}, 1.0e8f, 8.0f), 8.0f, 1e-4f);
  EXPECT_EQ(drag_impulse({0.0f, 0.5f, 0.5f}, 1.0f, 8.0f), 0.0f);
}

// The steady slip of a grain and the water around it, mu (a_u - F/M)/b, at steps from far below to far above mu/b.
TEST(SemiImplicitDrag, TerminalVelocityKnowsNoStep) {
  const double M = 2.0, m_f = 3.0, b = 60.0, grain_force = -12.0, water = 1.5, mu = M * m_f / (M + m_f);
  const double expected = mu * (water - grain_force / M) / b;
  for (const double kick : {1.0e-4, 1.0e-2, 1.0, 100.0}) {
    double u = 0.0, v = 0.0;
    for (double t = 0.0; t < 20.0 * mu / b || t < 20.0 * kick; t += kick) {
      const double free = v + kick * grain_force / M;
      u += kick * water;
      const double J = static_cast<double>(
          drag_impulse({static_cast<float>(b), static_cast<float>(1.0 / M), static_cast<float>(1.0 / m_f)},
                       static_cast<float>(kick), static_cast<float>(u - free)));
      v = free + J / M;
      u -= J / m_f;
    }
    EXPECT_NEAR((u - v) / expected, 1.0, 1e-3) << kick;
  }
}

TEST(ContactParameters, SaysWhatIsWrong) {
  ContactParameters p;
  p.restitution = 0.0;
  try {
    check_contact_parameters(p);
    FAIL() << "restitution 0 was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_NE(std::string(error.what()).find("contact.restitution"), std::string::npos);
  }
  p.restitution = 0.5;
  p.poisson_ratio = 0.5;
  EXPECT_THROW(check_contact_parameters(p), Error);
}

}  // namespace
}  // namespace gdesp::dem
