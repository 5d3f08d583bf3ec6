# SPDX-License-Identifier: BSD-3-Clause
# Turns the comments of a header into those that Doxygen reads; the lines keep their numbers. A
# comment stands for the declaration below it and, above a function, for those that follow without an
# empty line between, but for special members of a class. One with an empty line below it is about
# several and stands for none, but for the one that opens the header: that is the file's. Code between
# @code and @endcode stays as it is, and is of one declaration.

function escaped(text) {
  gsub(/\\/, "\\\\", text)
  gsub(/@/, "\\@", text)
  gsub(/</, "\\<", text)
  gsub(/>/, "\\>", text)
  return text
}

# How many more braces a line of code opens than it closes.
function opened(code,   text) {
  text = code
  gsub(/'.'|"[^"]*"/, "", text)
  return gsub(/\{/, "", text) - gsub(/\}/, "", text)
}

# The text of a line of the comment that is read, of code as it is.
function text_of(i,   text) {
  text = substr(comment[i], indent[i] + 2)
  return is_code[i] ? text : escaped(text)
}

# Prints the empty line that was held back, or `line` in its place.
function flush_held(line) {
  if (held) print line
  held = 0
}

function flush_comment(marker,   i) {
  for (i = 1; i <= pending; ++i) {
    print marker == "///" ? substr(comment[i], 1, indent[i] - 1) "///" text_of(i) : ""
  }
  pending = 0
}

# Whether code starts a function that the comment above the one before it stands for, too.
function declares(code) {
  return code ~ /\(/ && code !~ /^ *(#|\}|\)|friend |static_assert)/
}

# What a special member of a class is, "" for other code: no comment of another function suits it.
function special(code,   name, argument) {
  if (code ~ /^ *(virtual )?~/) return "Destructor."
  if (code ~ /\) = delete;/) return "Deleted."
  if (code ~ /operator=\(/) return code ~ /&&/ ? "Move assignment." : "Copy assignment."
  name = code
  sub(/^ */, "", name)
  argument = substr(name, index(name, "(") + 1)
  name = substr(name, 1, index(name, "(") - 1)
  sub(/^const /, "", argument)
  if (index(argument, name "&") != 1) return ""
  return index(argument, name "&&") == 1 ? "Move constructor." : "Copy constructor."
}

/^ *\/\// && body == 0 {
  if (index($0, "SPDX-License-Identifier") > 0) {
    print ""
    next
  }
  if (trailing > 0 && match($0, /\/\//) == trailing && pending == 0) {
    print substr($0, 1, trailing - 1) "///<" escaped(substr($0, trailing + 2))
    next
  }
  trailing = 0
  ++pending
  comment[pending] = $0
  match($0, /\/\//)
  indent[pending] = RSTART
  is_code[pending] = in_code || $0 ~ /^ *\/\/ @code/
  in_code = is_code[pending] && $0 !~ /^ *\/\/ @endcode/
  next
}

/^ *$/ && opening {
  if (pending > 0) {
    opening = 0
    flush_held("/// \\file")
    flush_comment("///")
    print ""
  } else {
    flush_held("")
    held = 1
  }
  next
}

/^ *$/ {
  flush_comment("")
  shared = ""
  trailing = 0
  print ""
  next
}

{
  opening = $0 == "#pragma once"
  flush_held("")
  code = $0
  note = ""
  trailing = 0
  # "://" is part of an address; what ends a namespace is named by its comment.
  if (body == 0 && code !~ /^} / && match(code, /[;,{})] +\/\/ /)) {
    at = RSTART + RLENGTH - 3
    trailing = at
    note = "///<" escaped(substr(code, at + 2))
    code = substr(code, 1, at - 1)
  }
  change = opened(code)
  if (body > 0) {
    body += change
    print $0
    next
  }
  if (pending > 0) {
    shared = ""
    if (code ~ /\(/) {
      for (i = 1; i <= pending; ++i) shared = shared (is_code[i] ? "" : text_of(i))
    }
    flush_comment("///")
  } else if (!continued && shared != "" && note == "" && declares(code)) {
    match(code, /^ */)
    about = special(code)
    about = about == "" ? shared : " " about
    code = substr(code, 1, RLENGTH) "/**" about " */ " substr(code, RLENGTH + 1)
  }
  is_scope = code ~ /(^| )(struct|class|enum|union|namespace) (alignas\([0-9]+\) )?[^;()]*\{ *$/ || code ~ /^extern "C"/
  if (change > 0 && !is_scope) body = change
  if (is_scope || code ~ /^ *(public|protected|private): *$/ || code ~ /^ *\};? *$/) shared = ""
  continued = code !~ /[;{}:] *$/ && code !~ /^ *#/
  print code note
}

END { flush_comment("") }
