# count.awk: of a build's output, how many files have been made instead of their names; what else is printed stays.
/^(CC|AR|LD|MAN) / { if (++n % 50 == 0) { print "  " n " files"; fflush() } next }
{ print; fflush() }
