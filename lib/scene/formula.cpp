// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/formula.hpp"

#include <charconv>
#include <cmath>
#include <vector>

#include "core/error.hpp"

namespace gdesp {

struct Formula::Node {
  char kind = 'n';  // n: number; x y z; + - * / ^; m: minus; f: function
  double value = 0.0;
  double (*function)(double) = nullptr;
  std::unique_ptr<Node> left, right;
};

namespace {

using Node = Formula::Node;
using Branch = std::unique_ptr<Node>;

struct NamedFunction {
  const char* name;
  double (*function)(double);
};
const NamedFunction functions[] = {
    {"sqrt", [](double v) { return std::sqrt(v); }}, {"exp", [](double v) { return std::exp(v); }},
    {"log", [](double v) { return std::log(v); }},   {"sin", [](double v) { return std::sin(v); }},
    {"cos", [](double v) { return std::cos(v); }},   {"tan", [](double v) { return std::tan(v); }},
    {"sinh", [](double v) { return std::sinh(v); }}, {"cosh", [](double v) { return std::cosh(v); }},
    {"tanh", [](double v) { return std::tanh(v); }}, {"abs", [](double v) { return std::fabs(v); }}};

// Recursive descent: sum of products of powers.
class Parser {
 public:
  static constexpr std::size_t longest = 1000;  // so that trees stay shallow
  explicit Parser(const std::string& text) : text_(text) {}

  Branch whole() {
    if (text_.size() > longest)
      throw Error(ErrorKind::input, "a formula has at most " + std::to_string(longest) +
                                        " characters; from character " + std::to_string(longest + 1) +
                                        " on it is too long");
    Branch root = sum();
    if (peek() != '\0') fail();
    return root;
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(ErrorKind::input,
                "the formula \"" + text_ + "\" cannot be read from character " + std::to_string(at_ + 1) +
                    " on; valid: numbers, x, y, z, pi, + - * / ^ ( ) and sqrt exp log sin cos tan sinh cosh "
                    "tanh abs");
  }
  char peek() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  static Branch node(char kind, Branch left, Branch right = nullptr) {
    auto n = std::make_unique<Node>();
    n->kind = kind;
    n->left = std::move(left);
    n->right = std::move(right);
    return n;
  }
  Branch sum() {
    Branch left = product();
    for (char c = peek(); c == '+' || c == '-'; c = peek()) {
      ++at_;
      left = node(c, std::move(left), product());
    }
    return left;
  }
  Branch product() {
    Branch left = signed_power();
    for (char c = peek(); c == '*' || c == '/'; c = peek()) {
      ++at_;
      left = node(c, std::move(left), signed_power());
    }
    return left;
  }
  Branch signed_power() {
    if (++depth_ > 200) fail();
    Branch result;
    if (peek() == '-') {
      ++at_;
      result = node('m', signed_power());
    } else {
      result = atom();
      if (peek() == '^') {
        ++at_;
        result = node('^', std::move(result), signed_power());
      }
    }
    --depth_;
    return result;
  }
  Branch atom() {
    const char c = peek();
    if (c == '(') return group();
    if ((c >= '0' && c <= '9') || c == '.') return number();
    std::string name;
    while (at_ < text_.size() && text_[at_] >= 'a' && text_[at_] <= 'z') name += text_[at_++];
    if (name == "x" || name == "y" || name == "z") return node(name[0], nullptr);
    Branch n = node('n', nullptr);
    if (name == "pi") {
      n->value = std::acos(-1.0);
      return n;
    }
    for (const NamedFunction& f : functions) {
      if (name != f.name) continue;
      if (peek() != '(') fail();
      n = node('f', group());
      n->function = f.function;
      return n;
    }
    at_ -= name.size();
    fail();
  }
  Branch group() {
    ++at_;
    Branch inner = sum();
    if (peek() != ')') fail();
    ++at_;
    return inner;
  }
  Branch number() {
    Branch n = node('n', nullptr);
    const auto r = std::from_chars(text_.data() + at_, text_.data() + text_.size(), n->value);
    if (r.ec != std::errc()) fail();
    at_ = static_cast<std::size_t>(r.ptr - text_.data());
    return n;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

double value_of(const Node& n, const Vec3d& r) {
  switch (n.kind) {
    case 'n':
      return n.value;
    case 'x':
      return r.x;
    case 'y':
      return r.y;
    case 'z':
      return r.z;
    case 'm':
      return -value_of(*n.left, r);
    case 'f':
      return n.function(value_of(*n.left, r));
    case '+':
      return value_of(*n.left, r) + value_of(*n.right, r);
    case '-':
      return value_of(*n.left, r) - value_of(*n.right, r);
    case '*':
      return value_of(*n.left, r) * value_of(*n.right, r);
    case '/':
      return value_of(*n.left, r) / value_of(*n.right, r);
    default:
      return std::pow(value_of(*n.left, r), value_of(*n.right, r));
  }
}

}  // namespace

Formula::Formula(const std::string& text) : root_(Parser(text).whole()) {}
Formula::~Formula() = default;
Formula::Formula(Formula&&) noexcept = default;
double Formula::operator()(const Vec3d& r) const { return value_of(*root_, r); }

}  // namespace gdesp
