#!/usr/bin/python3
"""comments.py HEADER: prints a header with its plain comments turned into those that doxygen reads. Line numbers stay.

    The comment that opens a file                  is of the file.
    A comment on lines of its own                  is of the declaration in the line below it.
    A comment behind a declaration, on its line    is of that declaration.
"""
import pathlib
import re
import sys


def escaped(text):
    """Text of a comment that doxygen takes as it stands, but for the names that it knows."""
    return re.sub(r"([\\@#%~])", r"\\\1", text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def laid_out(lines):
    """A comment's lines, without its marks, where what is set in under the rest keeps its shape."""
    texts = [re.sub(r"^\s*(/\*|\*(?!/))? ?", "", line).rstrip() for line in lines]
    texts[-1] = re.sub(r"\s*\*/$", "", texts[-1])
    texts = [escaped(text) for text in texts]
    set_in = [text.startswith("  ") for text in texts]
    for i, inside in enumerate(set_in):
        if inside and not (i > 0 and set_in[i - 1]):
            texts[i] = "<pre>" + texts[i]
        if inside and not (i + 1 < len(texts) and set_in[i + 1]):
            texts[i] += "</pre>"
    return texts


def without_comments(line):
    return re.sub(r"/\*.*?(\*/|$)", "", line)


def depth_of(line):
    """How many parentheses a line opens more than it closes."""
    bare = re.sub(r"'.'", "", without_comments(line))
    return bare.count("(") - bare.count(")")


class Filter:
    """Goes through a header line by line."""

    def __init__(self, path):
        self.name = path
        self.lines, self.at, self.out = pathlib.Path(path).read_text().splitlines(), 0, []
        self.depth = 0  # of parentheses

    def comment_end(self, start):
        """Index of the line in which the comment that begins in line `start` ends."""
        end = start
        while "*/" not in self.lines[end].split("/*")[-1]:
            end += 1
        return end

    def own_comment(self):
        end = self.comment_end(self.at)
        texts = laid_out(self.lines[self.at:end + 1])
        follows = self.lines[end + 1].strip() if end + 1 < len(self.lines) else ""
        if self.at == 0:
            texts[0] = f"/** @file {self.name} @brief {texts[0]}"
        elif follows and not follows.startswith(("/*", "#if", "#endif", "#include", "}")):
            texts[0] = "/** " + texts[0]
        else:
            texts[0] = "/* " + texts[0]
        texts[-1] += " */"
        self.out += texts
        self.at = end + 1

    def trailing(self, line):
        """Whether a line of code had a comment behind its declaration, which is made the declaration's then."""
        match = re.match(r"(.*[;,)}\w]\s*)/\*", line)
        if not match or self.depth + depth_of(line) != 0:
            return False
        end = self.comment_end(self.at)
        texts = [escaped(text) for text in [line[len(match.group(0)):], *self.lines[self.at + 1:end + 1]]]
        self.out += [match.group(1) + "/**<" + texts[0], *texts[1:]]
        self.at = end + 1
        return True

    def body(self):
        """The lines of an inline function, without what doxygen might read in them."""
        while not self.lines[self.at].startswith("}"):
            self.out.append("")
            self.at += 1
        self.out.append("}")
        self.at += 1

    def directive(self, line):
        """A line of the preprocessor; a comment behind a macro is the macro's."""
        self.out.append(re.sub(r"/\*.*\*/", lambda comment: "/**<" + escaped(comment.group(0)[2:-2]) + "*/", line))
        self.at += 1
        while self.out[-1].endswith("\\"):
            self.out.append(self.lines[self.at])
            self.at += 1

    def code(self, line):
        if not self.trailing(line):
            self.out.append(line)
            self.at += 1
        code = without_comments(line)
        self.depth += depth_of(code)
        if self.depth == 0 and re.search(r"\)\s*\{$", code.rstrip()):
            self.body()

    def result(self):
        while self.at < len(self.lines):
            line = self.lines[self.at]
            if line.strip().startswith("/*"):
                self.own_comment()
            elif line.startswith("#"):
                self.directive(line)
            else:
                self.code(line)
        return self.out


if __name__ == "__main__":
    print("\n".join(Filter(sys.argv[1]).result()))
