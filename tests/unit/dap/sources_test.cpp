#include "tools/faces/dap/requests/sources.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/scratch_folder.hpp"
#include "tests/unit/dap/editor.hpp"

namespace s7200::tools::dap::sources_test {
namespace {

namespace fs = std::filesystem;

TEST(Sources, AUriOfAFileIsItsPath) {
  const std::pair<std::string, std::string> kCases[] = {
      {"file:///home/me/plant.stl", "/home/me/plant.stl"},
      {"file:/home/me/plant.stl", "/home/me/plant.stl"},
      {"FILE://LOCALHOST/home/plant.stl", "/home/plant.stl"},
      {"file:///my%20plant/%C3%BC%25.stl", "/my plant/\xC3\xBC%.stl"},
      {"file:///100%/a%2", "/100%/a%2"},
      {"file:///a%00b", "/a%00b"},
      {"file://server/share/plant.stl", "file://server/share/plant.stl"},
      {"untitled:Untitled-1", "untitled:Untitled-1"},
      {"plant.stl", "plant.stl"},
      {"/file:/plant.stl", "/file:/plant.stl"},
  };
  for (const auto& [name, path] : kCases) EXPECT_EQ(path_of(name), path) << name;
  for (const std::string path : {"/home/me/plant.stl", "/my plant/\xC3\xBC%#?.stl", "/a:b/c+d"})
    EXPECT_EQ(path_of(uri_of(path)), path);
  EXPECT_EQ(uri_of("/my plant/50%.stl"), "file:///my%20plant/50%25.stl");
}

class Spellings : public testing::Test {
 protected:
  Spellings() {
    fs::create_directories(folder_ / "sub");
    std::ofstream(folder_ / "my plant.stl") << "LD SM0.0\n";
    if (!fs::exists(folder_ / "link.stl")) fs::create_symlink("my plant.stl", folder_ / "link.stl");
  }

  const fs::path folder_ = fs::canonical(test::scratch_folder());
};

TEST_F(Spellings, AllNamesOfAFileAreOne) {
  const std::string full = (folder_ / "my plant.stl").string(), here = folder_.string();
  for (const std::string& name :
       {full, here + "/./sub/..//my plant.stl", here + "/link.stl", uri_of(full), "file://" + here + "/my%20plant.stl"})
    EXPECT_EQ(full_name(name), full) << name;
  for (const std::string name : {"my plant.stl", "./link.stl", "sub/../my plant.stl"}) {
    EXPECT_EQ(full_name(name, here), full) << name;
    EXPECT_EQ(full_name(name, uri_of(here)), full) << name;
  }
  EXPECT_EQ(full_name(""), "");
}

TEST_F(Spellings, BreakpointsOfAnotherSpellingReplaceThoseBefore) {
  const std::string full = (folder_ / "my plant.stl").string();
  Editor editor(
      check_text("NETWORK 1\nLD SM0.0\nINCW VW0\nINCW VW2\nMEND\n", full, cpu214(), default_times(cpu214())).program);
  editor.begin({{"stopOnEntry", true}, {"cwd", folder_.string()}});
  const auto set = [&](const std::string& path, int line) {
    return editor("setBreakpoints",
                  {{"source", {{"path", path}}}, {"breakpoints", Json::array({{{"line", line}}})}})["breakpoints"][0];
  };
  EXPECT_EQ(set(full, 3)["verified"], true);
  EXPECT_EQ(set("sub/../my plant.stl", 4)["verified"], true);
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 4) << "the one in line 3 has gone";
  EXPECT_EQ(set(uri_of(full), 3)["verified"], true);
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 3);
}

TEST_F(Spellings, AClientOfUrisIsToldUris) {
  const std::string full = (folder_ / "my plant.stl").string();
  Editor editor(check_text("LD SM0.0\nINCW VW0\nMEND\n", full, cpu214(), default_times(cpu214())).program);
  editor("initialize", {{"adapterID", "s7200"}, {"pathFormat", "uri"}});
  editor("launch", {{"stopOnEntry", true}});
  editor("configurationDone");
  EXPECT_EQ(editor.frame()["source"]["path"], uri_of(full));
  EXPECT_EQ(editor("loadedSources")["sources"][0]["path"], uri_of(full));
  EXPECT_EQ(editor.error_of("initialize", {{"pathFormat", "url"}}), "pathFormat: 'url' is not path or uri");
}

}  // namespace
}  // namespace s7200::tools::dap::sources_test
