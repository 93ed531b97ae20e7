// SPDX-License-Identifier: GPL-3.0-or-later
// Stands in for Thrust on the emulated device.
#pragma once

namespace thrust {

template <class Base, class Body>
struct transform_iterator {
  Base base;
  Body body;
  auto operator[](int i) const { return body(base[i]); }
};
template <class Base, class Body>
transform_iterator<Base, Body> make_transform_iterator(Base base, const Body& body) {
  return {base, body};
}

}  // namespace thrust
