// The page of `s7200 inspect PROGRAM document`.
#include "tools/views/inspection/document_view.hpp"

#include "tests/support/inspected.hpp"
#include "tools/views/inspection/inspect_views.hpp"

namespace s7200::tools::document_view_test {
namespace {

bool has(const std::string& page, std::string_view text) { return page.find(text) != std::string::npos; }

TEST(DocumentView, HasContentsThatLeadToEachView) {
  const std::string page = document_text(test::inspected("LD I0.0\nCALL 1\nMEND\nSBR 1\nLD I0.1\n= Q0.0\nRET\n"));
  for (const InspectView& view : inspect_views()) {
    if (view.name == "document") continue;
    EXPECT_TRUE(has(page, "<a href=\"#" + std::string(view.name) + "\">")) << view.name;
    EXPECT_TRUE(has(page, "<h2 id=\"" + std::string(view.name) + "\">")) << view.name;
  }
  EXPECT_TRUE(has(page, "<h3 id=\"ladder-SBR_1\">SBR_1</h3>"));
  EXPECT_TRUE(has(page, "    5  LD I0.1\n")) << "the program as it was read";
}

TEST(DocumentView, NeedsNothingElseAndRunsNothing) {
  const std::string page = document_text(test::inspected("LD I0.0\n= Q0.0\nMEND\n"));
  for (const char* outside : {"http://", "https://", "<script", "<img", "<link", "src=\"", "url("})
    EXPECT_FALSE(has(page, outside)) << outside;
}

TEST(DocumentView, WhatTheProgramSaysIsTextAndNeverMarkup) {
  const std::string page = document_text(test::inspected(
      "NETWORK 1 // </pre><script>alert(1)</script>\nLD I0.0 // \" onload=\"x\n= Q0.0 // <b>&amp;</b>\nMEND\n"));
  EXPECT_FALSE(has(page, "<script"));
  EXPECT_FALSE(has(page, "<b>"));
  EXPECT_TRUE(has(page, "&lt;/pre&gt;&lt;script&gt;alert(1)&lt;/script&gt;"));
  EXPECT_TRUE(has(page, "&lt;b&gt;&amp;amp;&lt;/b&gt;"));
}

TEST(DocumentView, KeepsToTheRoutinesThatAreAskedFor) {
  const std::string page = document_text(test::inspected("LD I0.0\nCALL 1\nMEND\nSBR 1\nLD I0.1\n= Q0.0\nRET\n", {"SBR_1"}));
  EXPECT_TRUE(has(page, "id=\"ladder-SBR_1\""));
  EXPECT_FALSE(has(page, "id=\"ladder-MAIN\""));
}

TEST(DocumentView, TheSameProgramGivesTheSamePage) {
  constexpr std::string_view kProgram = "LD I0.0\n= Q0.0\nMEND\n";
  EXPECT_EQ(document_text(test::inspected(kProgram)), document_text(test::inspected(kProgram)));
  EXPECT_EQ(document_json(test::inspected(kProgram)), document_text(test::inspected(kProgram)));
}

}  // namespace
}  // namespace s7200::tools::document_view_test
