# Prepares a header for doxygen: the comment that opens it describes the file; #V is a count, not a link.
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
