// SPDX-License-Identifier: GPL-3.0-or-later
// Base64 (RFC 4648, section 4, with padding), as inline binary VTK files use it.
#pragma once

#include <cstddef>

namespace gdesp {

inline constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

/// Writes base64_size(count) characters.
void base64_encode(const unsigned char* bytes, std::size_t count, char* text);

/// Reads base64_size(count) characters into exactly `count` bytes; false when a character is not of the alphabet
/// or the padding is not the one that `count` demands.
bool base64_decode(const char* text, std::size_t count, unsigned char* bytes);

}  // namespace gdesp
