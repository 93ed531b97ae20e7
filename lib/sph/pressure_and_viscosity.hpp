// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.momentum
//   Dv_i/Dt = -(1/rho_i) sum_j V_j (P_i + P_j) grad W_ij + viscosity + g      (`accurate`)
//   Dv_i/Dt = -sum_j m (P_i/rho_i^2 + P_j/rho_j^2) grad W_ij + viscosity + g  (`paper`, eq. 5 as meant)
//   Both conserve linear momentum. rho: superficial density, porosity times true density [kg/m3]; P: pressure of the true
//   one [Pa]; v, g [m/s], [m/s2]; V = m/rho: volume [m3]; grad W [1/m4]. Written as c^2 B_i sum_j (A_i + A_j) B_j G_ij r_ij with G = -V0 (dW/dr)/r, V0 = dp^dimensions and
//     `accurate`: A = P/(rho0 c^2), B = rho0/rho;   `paper`: A = P rho0/(rho^2 c^2), B = 1.
//   Sources: Monaghan (2005), Rep. Prog. Phys. 68, 1703, doi:10.1088/0034-4885/68/8/R01; Robinson, Ramaioli, Luding
//   (2014), Int. J. Multiphase Flow 59, 121, doi:10.1016/j.ijmultiphaseflow.2013.11.003 (superficial density).
// @eq sph.viscosity.morris
//   sum_j m 2 mu (r_ij . grad W_ij) / (rho_i rho_j r_ij^2) v_ij; with (r . grad W)/r^2 = (dW/dr)/r it needs no division.
//   mu: dynamic viscosity [Pa s]. Source: eq. 6; Morris, Fox, Zhu (1997), doi:10.1006/jcph.1997.5776.
// @eq sph.viscosity.artificial
//   Pi_ij = -alpha h c (v_ij . r_ij) / (rho (r_ij^2 + 0.01 h^2)) for approaching particles, else 0; [m5/(kg s2)], as P/rho^2.
//   alpha [1]; h: smoothing length [m]; c: speed of sound [m/s]; rho: mean density of the two [kg/m3].
//   Source: Monaghan (1992), doi:10.1146/annurev.aa.30.090192.002551. Equivalent kinematic viscosity up to alpha h c/8
//   in two and alpha h c/10 in three dimensions.
// @eq sph.continuity
//   D rho_i/Dt = rho_i sum_j V_j v_ij . grad W_ij (`accurate`);  sum_j m v_ij . grad W_ij (`paper`, eq. 3).
//   rho [kg/m3]; V [m3]; v_ij = v_i - v_j [m/s]. Source: Monaghan (2005), as sph.momentum.
//   Extrapolated walls hand sph.wall.volume back besides.
// @eq sph.density-diffusion
//   delta h c sum_j 2 minmod(rho_j - rho_i, rho_j - rho_i - rho^H_ij) (r_ji . grad_i W)/r^2 V_j, rho^H_ij = rho0 g.(r_j - r_i)/c^2, so
//   that hydrostatics stay still; a rate of density [kg/(m3 s)]. minmod(a, b): the smaller in size, 0 where signs differ. delta [1]; h [m];
//   c [m/s]. Acts on the true density (through A), so times eps_i for the superficial one; between grains rho is that of the mixture
//   pressure, which the momentum sees: diffusion that evens out another pressure feeds energy into beds at rest (docs/decisions/0043).
//   Fluid pairs only. What a pair exchanges has the sign of its own difference of pressure, so that it never makes energy: without
//   the minmod still water rose for ever (docs/decisions/0055).
//   Source: Fourtakas et al. (2019), Comput. Fluids 190, 346, doi:10.1016/j.compfluid.2019.06.009; the sign: Fjordholm, Mishra,
//   Tadmor (2012), SIAM J. Numer. Anal. 50, 544, doi:10.1137/110836961.
#pragma once

#include "core/host_device.hpp"
#include "core/real.hpp"
#include "sph/pressure_and_viscosity_kinds.hpp"

namespace gdesp::sph {

/// What a pair adds up to, for one lane type.
template <class Real>
struct FluidRates {
  Real ax{0.0f}, ay{0.0f}, az{0.0f};  ///< acceleration / (c^2 B_i), 1/m (pressure and viscosity)
  Real compression{0.0f};             ///< -sum_j G B_j v_ij . r_ij, 1/s
  Real diffusion{0.0f};               ///< sum_j G B_j minmod(A_j - A_i, A_j - A_i + g . r_ij / c^2), 1/m^2
};

/// Coefficients of the pair terms, SI, prepared once.
struct FluidPairLaw {
  float inverse_support;  ///< 1/(2h), 1/m
  float slope;            ///< V0 5 alpha / h^2: G = slope * t^3, 1/m^2
  float artificial;       ///< alpha h / c, s
  float eta2;             ///< 0.01 h^2, m2
  float morris;           ///< 2 nu / c^2, s
  float gx, gy, gz;       ///< gravity / c^2, 1/m
};

/// Adds the pair (i, j). r = r_i - r_j, v = v_i - v_j. `friction` scales viscosity (1 fluid; 0 or 1 walls).
template <bool WithMomentum, bool WithContinuity, Viscosity Kind, bool WithDiffusion, class Real>
GDESP_HD inline void add_fluid_pair(const FluidPairLaw& law, const Real& rx, const Real& ry, const Real& rz,
                                    const Real& vx, const Real& vy, const Real& vz, const Real& A_i, const Real& A_j,
                                    const Real& B_j, const Real& friction, FluidRates<Real>& rates) {
  using real::max;
  using real::min;
  using real::reciprocal;
  using real::sqrt;
  const Real r2 = rx * rx + ry * ry + rz * rz;
  const Real t = max(Real(0.0f), Real(1.0f) - sqrt(r2) * Real(law.inverse_support));
  const Real G = Real(law.slope) * B_j * t * t * t;
  const Real vr = vx * rx + vy * ry + vz * rz;
  if constexpr (WithMomentum) {
    Real sum = A_i + A_j;
    if constexpr (Kind == Viscosity::artificial) {
      sum -= friction * Real(law.artificial) * min(vr, Real(0.0f)) * reciprocal(r2 + Real(law.eta2));
    }
    const Real push = G * sum;
    rates.ax += push * rx;
    rates.ay += push * ry;
    rates.az += push * rz;
    if constexpr (Kind == Viscosity::morris) {
      const Real drag = friction * Real(law.morris) * G;
      rates.ax -= drag * vx;
      rates.ay -= drag * vy;
      rates.az -= drag * vz;
    }
  }
  if constexpr (WithContinuity) {
    rates.compression -= G * vr;
    if constexpr (WithDiffusion) {
      const Real jump = A_j - A_i;
      const Real unbalanced = jump + Real(law.gx) * rx + Real(law.gy) * ry + Real(law.gz) * rz;
      const Real zero(0.0f);
      rates.diffusion += G * max(min(unbalanced, max(jump, zero)), min(jump, zero));
    }
  }
}

}  // namespace gdesp::sph
