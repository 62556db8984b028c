// Comments as other languages and editors write them: `(* … *)`, `/* … */`, `<!-- … -->`, `{ … }`; after a sign, up to the
// end of the line (kLineSigns has them); and in brackets after a statement, `LD I0.0 (start)`. They become comments with
// //, and code keeps its columns.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace s7200::stl::plain {

/// Whether a line may have such a comment.
bool may_have_foreign_comment(std::string_view line);

/// Rewrites the comments in the lines of a text. Returns which lines are different; none if all are the same.
std::vector<bool> rewrite_foreign_comments(std::vector<std::string>& lines);

}  // namespace s7200::stl::plain
