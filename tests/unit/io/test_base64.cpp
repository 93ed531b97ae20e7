// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "io/base64.hpp"

namespace gdesp {
namespace {

std::string encoded(const std::string& bytes) {
  std::string text(base64_size(bytes.size()), '?');
  base64_encode(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), text.data());
  return text;
}

/// Test vectors of RFC 4648, section 10.
TEST(Base64, vectors_of_the_standard) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(encoded(bytes), text);
}

TEST(Base64, any_bytes_come_back) {
  std::mt19937 engine(7);
  for (std::size_t count = 0; count < 300; ++count) {
    std::string bytes(count, '\0');
    for (char& c : bytes) c = char(engine());
    std::vector<unsigned char> back(count);
    ASSERT_TRUE(base64_decode(encoded(bytes).data(), count, back.data()));
    EXPECT_EQ(std::string(back.begin(), back.end()), bytes);
  }
}

TEST(Base64, foreign_characters_and_wrong_padding_are_refused) {
  unsigned char out[6];
  EXPECT_FALSE(base64_decode("Zm9-", 3, out));
  EXPECT_FALSE(base64_decode("Zm9v Zm9", 6, out));
  EXPECT_FALSE(base64_decode("Zm8A", 2, out));
  EXPECT_FALSE(base64_decode("ZgA=", 1, out));
  EXPECT_FALSE(base64_decode("\xff\xfe==", 1, out));
  EXPECT_FALSE(base64_decode("====", 3, out));
}

}  // namespace
}  // namespace gdesp
