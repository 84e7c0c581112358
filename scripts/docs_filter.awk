#!/usr/bin/awk -f
# Shows a header of this tree to Doxygen: its plain comments are documentation. Usage: docs_filter.awk HEADER
#
# - The comment at the top tells about the file.
# - A comment right above a declaration is its documentation; one before an empty line is about the code below in
#   general, and stays a comment, as do comments within functions.
# - A comment behind a declaration, with lines below it that begin in the same column, belongs to it.
# Text is text: what Doxygen would take for commands, tags or emphasis is escaped.

# Text as Doxygen shows it unchanged. A line that is indented, as formulas are, stays a line, but for those of lists.
function shown(text,  break_before, margin) {
  gsub(/@/, "\001", text)
  gsub(/\\/, "@\\\\", text)
  gsub("\001", "\\@", text)
  gsub(/&/, "\\&amp;", text)
  gsub(/</, "\\&lt;", text)
  gsub(/>/, "\\&gt;", text)
  gsub(/#/, "\\#", text)
  gsub(/\*/, "\\*", text)
  sub(/REQUIRES:/, "@pre", text)
  if (text ~ /^ *$/ || text ~ /^ [^ ]/) in_list = 0
  if (text ~ /^ *(-|[0-9]+\.) /) in_list = 1
  break_before = indented ? " <br>" : ""
  indented = text ~ /^   / && !in_list
  if (!indented) return break_before text
  match(text, /^ +/)
  margin = substr("&emsp;&emsp;&emsp;&emsp;&emsp;", 1, 6 * int(RLENGTH / 2))
  return " <br>" margin substr(text, RLENGTH + 1)
}

# Whether a line that opens a brace opens a scope of declarations.
function declares(line) {
  return line ~ /^ *(template *<.*> *)?(inline +)?(namespace|struct|class|union|enum|extern "C")/
}

{ lines[NR] = $0 }

END {
  first = 1
  if (lines[1] ~ /^\/\//) {
    print "/// @file"
    for (; lines[first] ~ /^\/\//; ++first) print "///" shown(substr(lines[first], 3))
  }
  depth = 0      # of braces
  body = 0       # the depth at which a function's body, or a value, began; 0: none
  column = 0     # of a comment behind a declaration, for the lines below
  for (i = first; i <= NR; ++i) {
    line = lines[i]
    at = match(line, /\/\/.*$/)
    code = at ? substr(line, 1, at - 1) : line
    text = at ? substr(line, at + 2) : ""
    alone = code ~ /^ *$/
    if (at && !body && alone && at == column) {
      print code "///<" shown(text)
      continue
    }
    column = 0
    if (line ~ /^extern template/) {  # of what is documented where it is defined
      while (lines[i] !~ /; *$/) ++i
      continue
    }
    if (at && !body && alone) {
      for (below = i; lines[below] ~ /^ *\/\//; ++below) {}
      attached = lines[below] !~ /^ *$/ && lines[below] !~ /^ *[})]/
      for (; i < below; ++i) print attached ? documented(lines[i]) : lines[i]
      --i
      continue
    }
    if (at && !body && code !~ /^ *}|\{ *$/) {
      column = at
      print code "///<" shown(text)
    } else {
      print line
    }
    stripped = code
    gsub(/"([^"\\]|\\.)*"|'([^'\\]|\\.)'/, "", stripped)
    opens = gsub(/{/, "{", stripped)
    closes = gsub(/}/, "}", stripped)
    if (!body && opens > closes && !declares(heading stripped)) body = depth + 1
    depth += opens - closes
    if (body && depth < body) body = 0
    # A declaration may go over several lines.
    heading = stripped ~ /^ *$|^#|[;:{}] *$/ ? "" : heading stripped " "
  }
}

# A comment line as documentation.
function documented(line,  start) {
  start = index(line, "//")
  return substr(line, 1, start - 1) "///" shown(substr(line, start + 2))
}
