// SPDX-License-Identifier: GPL-3.0-or-later
#include "mutator.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <set>

namespace gdesp::fuzz {
namespace {

using geometry::Random;

constexpr std::size_t longest = 1u << 16;

const char* const odd_numbers[] = {"0",
                                   "-1",
                                   "1e999",
                                   "-1e999",
                                   "nan",
                                   "inf",
                                   "1e-320",
                                   "2147483648",
                                   "-2147483649",
                                   "4294967296",
                                   "18446744073709551616",
                                   "9999999999999999999999",
                                   "0x7f",
                                   "1.5",
                                   "1e9",
                                   "65536",
                                   "00",
                                   "+1",
                                   ""};

std::size_t place(const std::string& text, Random& random) { return text.empty() ? 0 : random.below(text.size()); }

/// Another number in the place of one that is written in the text.
void replace_number(std::string& text, Random& random) {
  if (text.empty()) return;
  const std::size_t start = random.below(text.size());
  const auto digit = [&](std::size_t k) { return std::isdigit(static_cast<unsigned char>(text[k])) != 0; };
  std::size_t a = start;
  while (a < text.size() && !digit(a)) ++a;
  std::size_t b = a;
  while (b < text.size() && (digit(b) || text[b] == '.')) ++b;
  if (a < b) text.replace(a, b - a, odd_numbers[random.below(std::size(odd_numbers))]);
}

/// A binary number that readers of sizes and indices stumble over.
void replace_binary(std::string& text, Random& random) {
  static const std::uint64_t odd[] = {0,
                                      1,
                                      0x7f,
                                      0x80,
                                      0xff,
                                      0x7fff,
                                      0xffff,
                                      0x7fffffff,
                                      0x80000000,
                                      0xffffffff,
                                      0x7fffffffffffffff,
                                      ~0ull,
                                      0x7ff0000000000000,
                                      0x7ff8000000000000};
  const std::size_t width = std::size_t{1} << random.below(4);
  if (text.size() < width) return;
  const std::uint64_t value = odd[random.below(std::size(odd))];
  std::memcpy(text.data() + random.below(text.size() - width + 1), &value, width);
}

std::string piece_of(const std::string& text, Random& random) {
  const std::size_t at = place(text, random);
  return text.substr(at, 1 + random.below(64));
}

}  // namespace

Mutator::Mutator(std::vector<std::string> seeds) : seeds_(std::move(seeds)) {
  std::set<std::string> words;
  for (const auto& seed : seeds_) {
    std::string word;
    for (const char c : seed) {
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '$')
        word += c;
      else if (word.size() > 1 && word.size() < 40)
        words.insert(word), word.clear();
      else
        word.clear();
    }
  }
  words_.assign(words.begin(), words.end());
}

void Mutator::change(std::string& text, Random& random) const {
  const std::size_t at = place(text, random);
  switch (random.below(13)) {
    case 0:
      if (!text.empty()) text[at] = static_cast<char>(text[at] ^ (1 << random.below(8)));
      break;
    case 1:
      if (!text.empty()) text[at] = static_cast<char>(random.bits());
      break;
    case 2:
      text.insert(at, 1 + random.below(8), static_cast<char>(random.bits()));
      break;
    case 3:
      text.erase(at, 1 + random.below(32));
      break;
    case 4:
      text.insert(at, piece_of(text, random));
      break;
    case 5:
      text.resize(at);
      break;
    case 6:
      text.insert(at, piece_of(seeds_[random.below(seeds_.size())], random));
      break;
    case 7:
      if (!words_.empty()) text.insert(at, words_[random.below(words_.size())]);
      break;
    case 8:
    case 9:
    case 10:
      replace_number(text, random);
      break;
    case 11:
      replace_binary(text, random);
      break;
    default: {
      const std::string piece = piece_of(text, random);
      text.replace(at, piece.size(), piece);
    }
  }
  if (text.size() > longest) text.resize(longest);
}

std::string Mutator::variant(std::uint64_t index, std::size_t& which) const {
  Random random(index);
  which = static_cast<std::size_t>(index % seeds_.size());
  std::string text = seeds_[which];
  const std::size_t changes = 1 + random.below(1 + random.below(8));
  for (std::size_t k = 0; k < changes; ++k) change(text, random);
  return text;
}

}  // namespace gdesp::fuzz
