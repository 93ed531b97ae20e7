// SPDX-License-Identifier: GPL-3.0-or-later
// A real that counts: laws run once on it tell how many floating-point operations a pair or a contact takes. An
// addition, a multiplication, a division, a root, a maximum and a comparison count one each.
#pragma once

#include "core/real.hpp"

namespace gdesp::bench {

struct CountedReal {
  static inline long count = 0;
  float v = 0.0f;
  CountedReal() = default;
  CountedReal(float x) : v(x) {}
  CountedReal& operator+=(const CountedReal& b) {
    ++count;
    v += b.v;
    return *this;
  }
  CountedReal& operator-=(const CountedReal& b) {
    ++count;
    v -= b.v;
    return *this;
  }
  CountedReal& operator*=(const CountedReal& b) {
    ++count;
    v *= b.v;
    return *this;
  }
};
inline CountedReal counted(float x) {
  ++CountedReal::count;
  return x;
}
inline CountedReal operator+(const CountedReal& a, const CountedReal& b) { return counted(a.v + b.v); }
inline CountedReal operator-(const CountedReal& a, const CountedReal& b) { return counted(a.v - b.v); }
inline CountedReal operator*(const CountedReal& a, const CountedReal& b) { return counted(a.v * b.v); }
inline CountedReal operator/(const CountedReal& a, const CountedReal& b) { return counted(a.v / b.v); }
inline CountedReal operator-(const CountedReal& a) { return -a.v; }
inline bool operator<(const CountedReal& a, const CountedReal& b) {
  ++CountedReal::count;
  return a.v < b.v;
}
inline bool operator>(const CountedReal& a, const CountedReal& b) {
  ++CountedReal::count;
  return a.v > b.v;
}
inline CountedReal max(const CountedReal& a, const CountedReal& b) { return counted(real::max(a.v, b.v)); }
inline CountedReal min(const CountedReal& a, const CountedReal& b) { return counted(real::min(a.v, b.v)); }
inline CountedReal sqrt(const CountedReal& a) { return counted(real::sqrt(a.v)); }
inline CountedReal reciprocal(const CountedReal& a) { return counted(real::reciprocal(a.v)); }
inline CountedReal inverse_sqrt(const CountedReal& a) {
  ++CountedReal::count;  // a root and a quotient
  return counted(real::inverse_sqrt(a.v));
}
inline CountedReal select(bool c, const CountedReal& a, const CountedReal& b) { return c ? a : b; }

/// Operations of one call.
template <class Work>
double operations_of(const Work& work) {
  CountedReal::count = 0;
  work();
  return static_cast<double>(CountedReal::count);
}

}  // namespace gdesp::bench
