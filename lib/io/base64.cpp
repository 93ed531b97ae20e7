// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/base64.hpp"

#include <array>
#include <cstdint>
#include <cstring>

namespace gdesp {
namespace {

constexpr const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Two characters for every 12 bits.
struct PairTable {
  std::array<char[2], 4096> pair;
  PairTable() {
    for (unsigned i = 0; i < 4096; ++i) {
      pair[i][0] = alphabet[i >> 6];
      pair[i][1] = alphabet[i & 63];
    }
  }
};

/// Value of a character, or a value with a bit past the sixth when it is none.
struct ValueTable {
  std::array<std::uint8_t, 256> value;
  ValueTable() {
    value.fill(0x80);
    for (std::uint8_t i = 0; i < 64; ++i) value[static_cast<unsigned char>(alphabet[i])] = i;
  }
};

}  // namespace

void base64_encode(const unsigned char* bytes, std::size_t count, char* text) {
  static const PairTable table;
  const std::size_t triples = count / 3;
  for (std::size_t i = 0; i < triples; ++i, bytes += 3, text += 4) {
    const std::uint32_t bits = std::uint32_t(bytes[0]) << 16 | std::uint32_t(bytes[1]) << 8 | bytes[2];
    std::memcpy(text, table.pair[bits >> 12], 2);
    std::memcpy(text + 2, table.pair[bits & 4095], 2);
  }
  const std::size_t rest = count % 3;
  if (rest == 0) return;
  const std::uint32_t bits = std::uint32_t(bytes[0]) << 16 | (rest == 2 ? std::uint32_t(bytes[1]) << 8 : 0);
  text[0] = alphabet[bits >> 18];
  text[1] = alphabet[bits >> 12 & 63];
  text[2] = rest == 2 ? alphabet[bits >> 6 & 63] : '=';
  text[3] = '=';
}

bool base64_decode(const char* text, std::size_t count, unsigned char* bytes) {
  static const ValueTable table;
  const auto value = [](char c) { return std::uint32_t(table.value[static_cast<unsigned char>(c)]); };
  const std::size_t triples = count / 3;
  std::uint32_t bad = 0;
  for (std::size_t i = 0; i < triples; ++i, text += 4, bytes += 3) {
    const std::uint32_t a = value(text[0]), b = value(text[1]), c = value(text[2]), d = value(text[3]);
    bad |= a | b | c | d;
    const std::uint32_t bits = a << 18 | b << 12 | c << 6 | d;
    bytes[0] = static_cast<unsigned char>(bits >> 16);
    bytes[1] = static_cast<unsigned char>(bits >> 8);
    bytes[2] = static_cast<unsigned char>(bits);
  }
  const std::size_t rest = count % 3;
  if (rest != 0) {
    const std::uint32_t a = value(text[0]), b = value(text[1]), c = rest == 2 ? value(text[2]) : 0;
    bad |= a | b | c;
    if (text[3] != '=' || (rest == 1 && text[2] != '=')) return false;
    bytes[0] = static_cast<unsigned char>(a << 2 | b >> 4);
    if (rest == 2) bytes[1] = static_cast<unsigned char>(b << 4 | c >> 2);
  }
  return (bad & 0x80) == 0;
}

}  // namespace gdesp
