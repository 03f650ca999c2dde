# Prepares a header for doxygen: the comment that opens it describes the file; #V is a count, not a link.
# Links of the guide to pages that doxygen does not read become their text.
FILENAME ~ /\.md$/ {
  while (match($0, /\[[^]]*\]\(\.\.[^)]*\)/)) {
    text = substr($0, RSTART + 1, RLENGTH)
    $0 = substr($0, 1, RSTART - 1) substr(text, 1, index(text, "](") - 1) substr($0, RSTART + RLENGTH)
  }
  print
  next
}
NR == 1 { print "/// @file"; opening = 1 }
!/^\/\// { opening = 0 }
opening { sub(/^\/\//, "///") }
{
  comment = index($0, "//")
  if (comment && !/^ *#include/) {
    text = substr($0, comment)
    gsub(/#/, "\\#", text)
    $0 = substr($0, 1, comment - 1) text
  }
  print
}
