# Makes the manual page of a program, or its completion for bash, from the output of --help. That text consists of
# paragraphs, separated by one empty line:
#   the first       usage: PROGRAM ...
#   lists           entries "  TAG  MEANING", two blanks or more before the meaning, which goes on in lines indented by more
#                   than eight; a line at the margin right before the first entry is their title
#   all others      text
# Usage: PROGRAM --help | awk -f help.awk -v form=man|bash -v name=PROGRAM -v version=VERSION -v others="PROGRAM..."
{ line[NR] = $0 }

END {
    for (at = 1; line[at] != ""; at++)
        usage = usage (usage == "" ? "" : "\n") line[at]
    sub(/^[Uu]sage: /, "", usage)
    if (form == "man")
        man_begin()
    for (; at <= NR; at++)
        take(line[at])
    if (form == "man")
        man_end()
    else
        bash_end()
}

function take(text,    gap) {
    if (text ~ /^         /) {
        sub(/^ +/, "", text)
        if (form == "man")
            print roff(text)
    } else if (is_entry(text)) {
        sub(/^ +/, "", text)
        gap = match(text, /  +|$/)
        if (form == "man")
            man_entry(substr(text, 1, gap - 1), substr(text, gap + RLENGTH))
        else
            bash_entry(substr(text, 1, gap - 1))
    } else if (form == "man") {
        man_text(text, line[at - 1] == "", is_entry(line[at + 1]))
    }
}

function is_entry(text) { return text ~ /^  / && text !~ /^         / }

# --- manual page

function roff(text) {
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    if (text ~ /^[.']/)
        text = "\\&" text
    return text
}

function man_begin() {
    printf ".TH \"%s\" 1 \"\" \"ptriangle %s\" \"User Commands\"\n", toupper(name), version
}

# Its first text says in short what the program is for.
function man_name(text) {
    if (match(text, /[.,:;]( |$)/))
        text = substr(text, 1, RSTART - 1)
    printf ".SH NAME\n%s \\- %s%s\n", roff(name), tolower(substr(text, 1, 1)), roff(substr(text, 2))
    printf ".SH SYNOPSIS\n.nf\n%s\n.fi\n.SH DESCRIPTION\n", roff(usage)
}

function man_text(text, first, before_entries) {
    if (text == "")
        return
    if (!named++)
        man_name(text)
    else if (first && before_entries) {
        print (sections++ ? "" : ".SH OPTIONS AND FILES\n") ".SS " roff(text)
        return
    } else if (sub(/^Exit code: /, "", text))
        print ".SH EXIT STATUS"
    else if (first || in_entry)
        print ".PP"
    in_entry = 0
    print roff(text)
}

function man_entry(tag, meaning) {
    printf "%s.TP\n.B %s\n%s", sections++ ? "" : ".SH OPTIONS\n", roff(tag), meaning == "" ? "" : roff(meaning) "\n"
    in_entry = 1
}

function man_end(    n, word, i, list) {
    n = split(others, word, " ")
    for (i = 1; i <= n; i++)
        if (word[i] != name)
            list = list (list == "" ? "" : ",\n") ".BR " roff(word[i]) " (1)"
    print ".SH SEE ALSO\n" list
}

# --- completion: options, and the values of those that take one of a few words

function bash_entry(tag,    n, word, i, value) {
    n = split(tag, word, /[ ,=]+/)
    if (word[n] ~ /^[a-z]+(\|[a-z]+)+$/) {
        value = word[n]
        gsub(/\|/, " ", value)
    }
    for (i = 1; i <= n; i++)
        if (word[i] ~ /^(-[A-Za-z]|--[a-z-]+)$/) {
            options = options " " word[i]
            if (value != "")
                cases = cases "    " word[i] ") COMPREPLY=($(compgen -W \"" value "\" -- \"$word\")); return ;;\n"
        }
}

function bash_end(    id) {
    id = name
    gsub(/[^A-Za-z0-9]/, "_", id)
    printf "# bash completion for %s %s\n_%s_words()\n{\n", name, version, id
    printf "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}\n"
    printf "    COMPREPLY=()\n    case $before in\n%s    esac\n", cases
    printf "    case $word in\n    -*) COMPREPLY=($(compgen -W \"%s\" -- \"$word\")) ;;\n    esac\n}\n", substr(options, 2)
    printf "complete -o default -F _%s_words %s\n", id, name
}
