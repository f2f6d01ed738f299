#include "harness/core/toml.hpp"

#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TomlFile parsed(std::string_view text) {
  auto file = TomlFile::parse(text, "case.toml");
  EXPECT_TRUE(file) << file.error().to_string();
  return *file;
}

// The error of finish(); empty if there is no error.
std::string complaints(const TomlFile& file) {
  const auto done = file.finish();
  return done ? "" : done.error().to_string();
}

TEST(Toml, GivesEveryTypeOfValue) {
  const TomlFile file = parsed(
      "why = 'steps'\n"
      "thrust = 0.5\n"
      "ticks = 12\n"
      "tailsitter = true\n"
      "q = [1, 0.5, nan, -inf]\n"
      "names = ['a', 'b']\n"
      "rates = [50, 250]\n"
      "[unit]\n"
      "p = 3\n");
  const TomlTable root = file.root();
  EXPECT_EQ(root.text("why"), "steps");
  EXPECT_EQ(root.number("thrust"), 0.5);
  EXPECT_EQ(root.integer("ticks"), 12);
  EXPECT_TRUE(root.boolean("tailsitter", false));
  const std::vector<double> q = root.numbers("q");
  ASSERT_EQ(q.size(), 4u);
  EXPECT_EQ(q[0], 1);
  EXPECT_TRUE(std::isnan(q[2]));
  EXPECT_EQ(q[3], -INFINITY);
  EXPECT_THAT(root.texts("names"), ElementsAre("a", "b"));
  EXPECT_THAT(root.integers("rates"), ElementsAre(50, 250));
  EXPECT_EQ(root.table("unit").number("p"), 3);  // an integer is a number
  EXPECT_EQ(complaints(file), "");
}

TEST(Toml, GivesFallbacksForWhatIsAbsent) {
  const TomlFile file = parsed("");
  const TomlTable root = file.root();
  EXPECT_EQ(root.text("a", "x"), "x");
  EXPECT_EQ(root.number("b", 1.5), 1.5);
  EXPECT_EQ(root.integer("c", 7), 7);
  EXPECT_TRUE(root.boolean("d", true));
  EXPECT_FALSE(root.has("e"));
  EXPECT_EQ(complaints(file), "");
}

TEST(Toml, TellsKindsApart) {
  const TomlFile file = parsed("b = true\ni = 1\nn = 1.0\nt = ''\na = []\nd = 1979-05-27\n[s]\n");
  const TomlTable root = file.root();
  EXPECT_EQ(root.kind("b"), TomlKind::boolean);
  EXPECT_EQ(root.kind("i"), TomlKind::integer);
  EXPECT_EQ(root.kind("n"), TomlKind::number);
  EXPECT_EQ(root.kind("t"), TomlKind::text);
  EXPECT_EQ(root.kind("a"), TomlKind::array);
  EXPECT_EQ(root.kind("d"), TomlKind::text);
  EXPECT_EQ(root.kind("s"), TomlKind::table);
  EXPECT_EQ(root.kind("no"), TomlKind::absent);
}

TEST(Toml, GivesKeysInTheOrderOfTheFile) {
  const TomlFile file = parsed("z = 1\nb = 2\n[a]\n[c]\n");
  EXPECT_THAT(file.root().keys(), ElementsAre("z", "b", "a", "c"));
}

TEST(TomlErrors, SyntaxHasLineAndColumn) {
  const auto file = TomlFile::parse("x = 1\ny = what\n", "case.toml");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().to_string(),
            "case.toml:2:5: not valid TOML: Error while parsing value: "
            "could not determine value type");
}

TEST(TomlErrors, UnreadableFileIsNamed) {
  const TemporaryDirectory directory;
  const std::string missing = (directory.path() / "missing.toml").string();
  EXPECT_EQ(TomlFile::read(missing).error().to_string(),
            missing + ": cannot open the file: No such file or directory");
  const auto path = directory.write("bad.toml", "x = 1\nx = 2\n");
  EXPECT_EQ(TomlFile::read(path).error().to_string(),
            path.string() +
                ":2:5: not valid TOML: Error while parsing key-value pair: cannot redefine "
                "existing integer 'x'");
}

TEST(TomlErrors, GarbageIsAnErrorNotACrash) {
  std::string bytes;
  for (int i = 0; i < 4096; ++i) bytes += static_cast<char>(i * 97 % 256);
  EXPECT_FALSE(TomlFile::parse(bytes, "x"));
  EXPECT_FALSE(TomlFile::parse(std::string(100, '\0'), "x"));
  EXPECT_FALSE(TomlFile::parse("a = " + std::string(10000, '['), "x"));
}

// `count` times `part`, separated by dots.
std::string dotted(int count, const std::string& part) {
  std::string key = part;
  for (int i = 1; i < count; ++i) key += "." + part;
  return key;
}

TEST(TomlErrors, DeepTablesAreAnErrorNotACrash) {
  constexpr int levels = 50000;
  const std::string key = dotted(levels, "a"), quoted = dotted(levels, "\"a.b\"");
  std::string opening, closing;
  for (int i = 0; i < levels; ++i) {
    opening += "{ a = ";
    closing += " }";
  }
  for (const std::string& text :
       {key + " = 1", quoted + " = 1", "[" + key + "]", "[[" + key + "]]",
        "x = { " + key + " = 1 }", "x = " + opening + "1" + closing,
        "x = \"\"\"a\\\"\"\"\"\n" + key + " = 1", "x = '''a'''''\n" + key + " = 1"}) {
    EXPECT_FALSE(TomlFile::parse(text, "x")) << text.substr(0, 40);
  }
  EXPECT_EQ(TomlFile::parse("# \"\nü = 1.5\n\"ü\"." + key, "x").error().to_string(),
            "x:3:66: tables or arrays are nested more than 32 deep; no file of attest needs that");
}

TEST(Toml, DotsThatSeparateNoPartsOfAKeyAreNotCounted) {
  const std::string dots(100, '.');
  EXPECT_TRUE(TomlFile::parse(dotted(32, "a") + " = 1", "x"));
  std::string numbers = "n = [";
  for (int i = 0; i < 100; ++i) numbers += "1.5, ";
  EXPECT_TRUE(TomlFile::parse(numbers + "]", "x"));
  for (const std::string& text :
       {"# " + dots, "a = \"" + dots + "\"", "a = '" + dots + "'", "a = \"\\\"" + dots + "\"",
        "a = \"\"\"\n" + dots + "\\\"\"\"\"", "a = '''\n" + dots + "'''", "a = \"\" # " + dots}) {
    EXPECT_TRUE(TomlFile::parse(text, "x")) << text.substr(0, 40);
  }
}

TEST(TomlErrors, MissingKeyIsAtItsTable) {
  const TomlFile file = parsed("a = 1\n[unit]\nb = 2\n");
  EXPECT_EQ(file.root().integer("a"), 1);
  EXPECT_EQ(file.root().text("why"), "");
  EXPECT_EQ(file.root().table("unit").integer("b"), 2);
  EXPECT_EQ(file.root().table("unit").number("thrust"), 0);
  EXPECT_EQ(complaints(file),
            "case.toml:1:1: missing key `why`; it must be text\n"
            "case.toml:2:2: missing key `thrust`; it must be a number");
}

TEST(TomlErrors, MissingTableIsReportedOnceWithoutItsKeys) {
  const TomlFile file = parsed("");
  const TomlTable unit = file.root().table("unit");
  EXPECT_EQ(unit.text("why"), "");
  EXPECT_EQ(unit.number("thrust", 2), 2);
  EXPECT_EQ(unit.table("deeper").kind("x"), TomlKind::absent);
  EXPECT_THAT(unit.keys(), IsEmpty());
  EXPECT_EQ(complaints(file), "case.toml:1:1: missing key `unit`; it must be a table");
}

TEST(TomlErrors, MismatchSaysWhatIsNeededAndWhatWasFound) {
  const TomlFile file = parsed(
      "a = 1\n"
      "b = 'x'\n"
      "c = 1.5\n"
      "d = 0\n"
      "e = 1\n"
      "f = [1, 'x',\n"
      "     true]\n"
      "g = ['x', 2]\n"
      "h = [1, 2.5]\n"
      "i = 1979-05-27\n"
      "[j]\n"
      "[k]\n");
  const TomlTable root = file.root();
  EXPECT_EQ(root.text("a"), "");
  EXPECT_EQ(root.number("b", 7), 7);
  EXPECT_EQ(root.integer("c"), 0);
  EXPECT_TRUE(root.boolean("d", true));
  root.table("e");
  EXPECT_THAT(root.numbers("f"), ElementsAre(1));
  EXPECT_THAT(root.texts("g"), ElementsAre("x"));
  EXPECT_THAT(root.integers("h"), ElementsAre(1));
  root.text("i");
  root.numbers("j");
  root.text("k", "");
  EXPECT_EQ(complaints(file),
            "case.toml:1:1: `a` must be text, found an integer\n"
            "case.toml:2:1: `b` must be a number, found text\n"
            "case.toml:3:1: `c` must be an integer, found a floating point number\n"
            "case.toml:4:1: `d` must be true or false, found an integer\n"
            "case.toml:5:1: `e` must be a table, found an integer\n"
            "case.toml:6:9: `f[1]` must be a number, found text\n"
            "case.toml:7:6: `f[2]` must be a number, found a boolean\n"
            "case.toml:8:11: `g[1]` must be text, found an integer\n"
            "case.toml:9:9: `h[1]` must be an integer, found a floating point number\n"
            "case.toml:10:1: `i` must be text, found a date or time without quotes\n"
            "case.toml:11:2: `j` must be an array of numbers, found a table\n"
            "case.toml:12:2: `k` must be text, found a table");
}

TEST(TomlErrors, UnknownKeyGetsASuggestion) {
  const TomlFile file = parsed("thurst = 0.5\n[other]\nx = 1\n[unit]\nno = 1\n");
  file.root().number("thrust", 0);
  file.root().table("unit");
  const auto done = file.finish();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().file, "case.toml");
  EXPECT_EQ(done.error().line, 1);
  EXPECT_EQ(done.error().column, 1);
  EXPECT_EQ(done.error().message,
            "unknown key `thurst`; did you mean `thrust`?\n"
            "case.toml:2:2: unknown key `other`\n"
            "case.toml:5:1: unknown key `no`");
}

TEST(TomlErrors, KeyThatWasOnlyLookedAtHasNoEffect) {
  const TomlFile file = parsed("a = 1\nb = 2\n");
  EXPECT_TRUE(file.root().has("a"));
  EXPECT_EQ(file.root().integer("b"), 2);
  EXPECT_EQ(complaints(file), "case.toml:1:1: key `a` has no effect here; remove it");
  file.root().integer("a");
  EXPECT_EQ(complaints(file), "");
}

TEST(TomlErrors, FileThatNobodyAskedAnythingIsAllUnknown) {
  EXPECT_EQ(complaints(parsed("a = 1\n")), "case.toml:1:1: unknown key `a`");
  EXPECT_EQ(complaints(parsed("")), "");
}

TEST(TomlErrors, ReadersErrorsStandAtTheirKey) {
  const TomlFile file = parsed("a = 1\n  b = -2\n[t]\nc = 3\n");
  const TomlTable root = file.root();
  root.integer("a");
  root.error("b", "must be positive");
  root.table("t").error("d", "give c or d");
  root.table("t").integer("c");
  root.error("b", "must be positive");
  EXPECT_EQ(complaints(file),
            "case.toml:2:3: must be positive\n"
            "case.toml:3:2: give c or d");
}

TEST(Toml, SharesWhatWasAskedAmongViewsOfATable) {
  const TomlFile file = parsed("[t]\na = 1\nb = 2\n");
  const TomlTable root = file.root();
  const TomlTable copy = root;
  root.table("t").integer("a");
  copy.table("t").integer("b");
  EXPECT_EQ(complaints(file), "");
}

TEST(Toml, ViewsOutliveTheFile) {
  const TomlTable root = parsed("a = 1\n").root();
  EXPECT_EQ(root.integer("a"), 1);
}

TEST(Toml, AKeyWithALineEndIsNoLineOfTheMessage) {
  const TomlFile file = parsed("\"a\\nb.toml:1:1: fine\" = 1\n");
  EXPECT_EQ(complaints(file), "case.toml:1:1: unknown key `a\\x0ab.toml:1:1: fine`");
}

TEST(Toml, CountsColumnsInCharacters) {
  const TomlFile file = parsed("u = { 'gr\xC3\xB6\xC3\x9F' = 1, no = 2 }\n");
  file.root().table("u").integer("gr\xC3\xB6\xC3\x9F");
  EXPECT_EQ(complaints(file), "case.toml:1:19: unknown key `no`");
}

TEST(Toml, TheCanonicalTextHasTheDataOnly) {
  const std::string_view canonical =
      R"({"a":[1,-0,nan,-inf,1e+16,10000000000000000,true,"1",],"b":{"\"c\\nd":{},},})";
  for (const char* text :
       {"a = [1, -0.0, nan, -inf, 1e16, 10000000000000000, true, '1']\nb = { '\"c\\nd' = {} }\n",
        "b.'\"c\\nd' = {}\na = [ 0x1, -0e0, -nan, -inf,\n 1.0e+16, 10_000_000_000_000_000,\n"
        " true, \"\\u0031\" ]\n"}) {
    EXPECT_EQ(parsed(text).canonical(), canonical) << text;
  }
}

TEST(Toml, TheCanonicalTextLeavesOutKeys) {
  const TomlFile file = parsed("why = 1\nb = 2\n[t]\nwhy = 3\nb = 4\n[t.u]\nwhy = 5\n");
  constexpr std::array<std::string_view, 4> without{"why", "t.b", "b.why", "absent.why"};
  EXPECT_EQ(file.canonical(without), R"({"b":2,"t":{"u":{"why":5,},"why":3,},})");
}

}  // namespace
}  // namespace attest
