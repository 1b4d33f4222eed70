"""How a sentence of a self-description speaks: of whom, of now or before, for or against. Rules of text, no model.

Nothing here knows what is spoken of; `facts.py` looks for words, and asks here how they stand. The rules err to the
side of hearing nothing: what another person does, what is over, a wish, and a figure of speech are not stated facts.
"""

from __future__ import annotations

import re
from typing import Literal, NamedTuple, TypeAlias

Standing: TypeAlias = Literal["does", "seldom", "dislikes", "never", "past", "wish", "other"]
"""How words stand in a clause: the person does it, seldom, dislikes it, never does it; did; wants to; somebody else."""

_SHORT = (
    (r"\bcan'?t\b|\bcan not\b", "cannot"),
    (r"\bwon'?t\b", "will not"),
    (r"\bain'?t\b", "am not"),
    (r"\b(do|does|did|is|are|was|were|would|could|should|have|has|had)n'?t\b", r"\1 not"),
    (r"\bi'?m\b", "i am"),
    (r"\b(i|we|you|they)'?ve\b", r"\1 have"),
    (r"\b(i|you|he|she|they)'d (rather|like|love|prefer)\b", r"\1 would \2"),
    (r"\b(we|they|you)'re\b", r"\1 are"),
    (r"\b(he|she|it|that)'s\b", r"\1 is"),
    (r"\b(mom|mum|mother|dad|father|brother|sister|wife|husband|son|daughter)'s (?=an?\b|the\b|not\b)", r"\1 is "),
)
_FIGURES = re.compile(
    r"\b(?:scared to death|dog tired|dog days|hot dogs?|(?:raining )?cats and dogs|cat nap|"
    r"play (?:it by ear|hard to get|with fire|dumb|devil's advocate|the (?:lottery|lotto|market|stock market|"
    r"field))|"
    r"(?:running|runs?|ran) (?:out of|late|low|into|away|around like|for "
    r"(?:office|mayor|president)|in (?:my|the|our) family|on coffee|things|errands|wild|deep)|in the long run|"
    r"read (?:minds?|people(?: like an? (?:open )?book)?|between the lines|palms|the room)|mind reading|"
    r"mind reader|cook the books|"
    r"piece of cake|cakewalk|(?:an|my) arm and a leg|pull(?:ing)? (?:my|your|his|her) leg|break a leg|"
    r"blind (?:dates?|faith|spot|as a bat)|colou?r ?blind|love is blind|turn a (?:blind|deaf) \w+|blind in one eye|"
    r"tone deaf|draw (?:attention|the line|a line|blood)|paint (?:the town|a picture of)|swim(?:ming)? in|"
    r"kick (?:back|the habit|the bucket)|jump (?:to conclusions|at)|jumping to conclusions|"
    r"lift(?:ing|s)? (?:(?:my|your|his|her|their|up) )?(?:spirits?|others|people|moods?)|dance around the|"
    r"old (?:soul|school|fashioned|fashion)|young at heart|at heart|with one hand tied|weight of the world|"
    r"work like a (?:dog|horse)|the cat's out|cat got|let the cat|work in progress|on the run|ring a bell|"
    r"(?:took|takes?|taking) a (?:shower of|bath in)|shopping spree for|bookmaker|sleep(?:ing)? with the fishes|"
    r"sing the praises of|green with envy|heart ?broken|broken heart|spill the tea|not my cup of tea|"
    r"(?:let (?:him|her|them) believe|pretend)(?: that)? i\b[^,;]*|i remember when\b[^,;]*|couch surf\w*|"
    r"channel surf\w*|walk all over|wears? the pants|skate over|fish for compliments)\b"
)
_SIMILE = re.compile(
    r"\b(?:(?<=feel )|(?<=feels )|(?<=look )|(?<=looks )|(?<=eat )|(?<=sleep )|(?<=work )|(?<=live )|(?<=sing )|"
    r"(?<=am )|(?<=are )|(?<=run )|(?<=swim )|(?<=drink )|(?<=act )|(?<=dance )|(?<=smell )|(?<=sound )|(?<=me )|"
    r"(?<=just )|(?<=more ))like (?:an?|my|the|some)\b[^,;]*|\bas \w+ as an?\b[^,;]*"
)
_NOT_AGAINST = re.compile(
    r"\b(?:(?:do|did|will|would|could|can|am|have) ?not|never|hate to|cannot) (?:(?:ever|really|to) )?(?:skip|"
    r"miss|forget|"
    r"stop|wait|mind|(?:get|have) enough|imagine|live without|go (?:a|one|through a) \w+ without|be without|help|"
    r"resist|tire|get tired|say no|trade|sit still|do without|leave (?:\w+ )?without|function without|put \w+ down|"
    r"sleep without|start (?:\w+ )*without)\b"
    r"|\bnot (?:only|just|to mention)\b|\bnothing (?:better|beats)\b|\bno (?:matter|doubt|wonder)\b|"
    r"\bnever without\b"
    r"|\bcannot \w+ without\b"
)
_BREAKS = re.compile(
    r"[;:]\s*|,?\s*\b(?:but|because|although|though|while|whereas|unless|so that|when|whenever|after(?= \w+ing|"
    r" i\b)|"
    r"before(?= \w+ing| i\b)|until(?= i\b| my\b)|(?=who\b)|which|where|since(?= i\b| my\b| \w+ing\b)|if)\b\s*"
    r"|(?:,\s*(?:and|or|so)?|\b(?:and|or|so))\s*(?=(?:then |now |also |sometimes |therefore )?"
    r"(?:i|we|my|our|he|she|they|it|his|her|their|the only)\b)"
    r"|,?\s*\band (?=(?:also |really )?(?:love|like|enjoy|prefer|adore|am|have|hate|dislike|work|live|spend|own|"
    r"teach)\b)"
    r"|(?=\b(?:rather than|instead of)\b)"
)
RELATIVE = (
    r"(?:(?:step|half|great|god)[ -]?)*(?:grand ?)?(?:father|mother|dad|daddy|mom|mum|mommy|mummy|pa|ma|"
    r"parents?|brothers?|"
    r"sisters?|sons?|daughters?|uncles?|aunts?|aunties|cousins?|nephews?|nieces?|husband|wife|spouse|partner|"
    r"boyfriend|girlfriend|fianc[eé]e?|kids?|child(?:ren)?|bab(?:y|ies)|toddlers?|friends?|boss|neighbou?rs?|"
    r"family|"
    r"roommates?|flatmates?|ex|twins?|girls|boys|folks|in laws?|pa|grandma|grandpa|granny|coworkers?|colleagues?)"
)
_KIN = re.compile(rf"(?:my|our|his|her|their|a|the)(?: (?!and\b|i\b)[\w']+){{0,2}}? {RELATIVE}(?:'s|s')?\b")
_OTHERS = re.compile(
    rf"^(?:(?:and|also|now|today|sometimes|both|all|one|two|some|most) (?:of )?)*(?:(?:my|our|his|her|their)"
    rf"(?: (?!and\b|i\b|favou?rite\b)[\w']+){{0,3}}? {RELATIVE}(?:'s|s')?\b|(?:mom|mum|dad|he|she|they|his|her|"
    rf"their)\b)"
)
_AND_I = re.compile(r"\band (?:i|me|myself)\b|\bi and\b")
_VERB_ONLY = re.compile(
    r"^(?:also |really )?(?:love|like|enjoy|prefer|adore|am|have|hate|dislike|work|live|spend|own|teach)\b"
)
_LEFT_OVER = re.compile(
    r"^(?:is|has|loves|likes|enjoys|hates|works|plays|lives|does|owns|runs|teaches|wants|drinks|eats|uses|was)\b"
)
_WITH = re.compile(r"\b(?:with|and|to|for|of|from|about|at|by|near|than|take|bring|meet|visit)$")
_PREFACE = re.compile(
    r"\b(?:watch(?:ing)?|see(?:ing)?|hear(?:ing)?|let(?:ting)?|driv(?:e|ing)|cheer(?:ing)? (?:on|for)|"
    r"support(?:ing)?|"
    r"listen(?:ing)? to|love|loved|like|hate|miss)$"
)
_PAST = re.compile(
    r"(?<!am )(?<!get )(?<!got )(?<!are )(?<!getting )(?<!is )\bused to (?!be an? (?:\w+ ){0,2}and still)"
    r"|\b(?:as an? (?:(?:young|little|small) )?(?:kid|child|boy|girl|teen|teenager|youth)|growing up|"
    r"in my (?:youth|childhood)|"
    r"years ago|back (?:then|in (?:the|my|high|\d))|in the past|formerly|in (?:high )?school i|my (?:former|old|"
    r"last|previous|"
    r"first) (?:job|career|boss)|"
    r"last (?:year|summer|month|week|spring|fall|winter))\b"
    r"|(?:^|\b)i (?:(?:always|also|really|once|never|often|just|even) )?(?:was|were|had(?! to)|did(?! not)|"
    r"loved|liked|enjoyed|"
    r"played|worked|cooked|danced|lived|collected|painted|studied|taught|ran|wrote|wanted|owned|attended|served|"
    r"went|spent|raced|drove|swam|sang|helped|competed|grew|trained|wrestled|hated|won|met|thought|tried|rode|"
    r"coached)\b"
    r"|\b(?:my|our)(?: [\w']+){1,5} (?:was|were|used to)\b|\b(?:ex|former|formerly)\b"
)
_STILL = re.compile(r"\b(?:still|to this day|ever since|nowadays|these days|currently|now i)\b")
_WISH = re.compile(
    r"\b(?:want(?:s|ed|ing)? (?:\w+ )?to|wanna|hope|hoping|wish|would (?:really )?(?:like|love)|dream(?:s|ing)?|"
    r"plan(?:s|ning)? (?:to|on)|planning|going to (?:be|become|get|buy|adopt|start)|someday|some day|one day i|"
    r"(?:to|would) become|becoming|studying to be|training to be|school to be|"
    r"aspir\w+|dying to|goal|will (?:be|become|get|have|start)|next year|in the future|thinking (?:of|about)|"
    r"considering|"
    r"cannot wait|looking for|in line for|saving (?:up )?(?:for|to)|could be|should be|trying to (?:be|become|"
    r"get|start))\b"
)
_NEVER = re.compile(
    r"\b(?:hate[sd]?|hating|detest|loathe|despise|abhor|cannot|never|not|no|avoid(?:ing)?|refuse to|unable to|"
    r"nor|neither|"
    r"no longer|dropped out of|stopped|quit|gave up|given up|giving up|do without|without|zero|nothing|terrified of|"
    r"allergic to|sick of|"
    r"banned from|free of|afraid of|scared of|phobia of|fear of|anti)\b"
)
_SOFTLY = re.compile(
    r"\b(?:like|love|enjoy|care|much|often|always|good|great|time|very|really|big|a lot|fond|fan|into|every|"
    r"interested|keen|crazy|feel|the best|too|all day|anymore|mood)\b"
)
_HARD = re.compile(r"\b(?:hate[sd]?|never|not at all)\b")
_LITTLE = re.compile(r"\b(?:much|often|a lot|anymore|well|enough)\b")
_DISLIKES = re.compile(
    r"\b(?:dislike[sd]?|too (?:old|shy|lazy|weak|tired|fat) (?:for|to)|bad at|terrible at|awful at|poor at|"
    r"horrible at|worst|bored (?:of|by|with)|tired of|"
    r"rather .* than|^(?:rather than|instead of)|prefer .* over|prefer .* to an?\b(?! \w+ing)|struggle (?:to|"
    r"with))\b"
)
_SELDOM = re.compile(
    r"\b(?:no time (?:for|to)|not (?:often |ever )?have (?:the |much |any |enough )?time (?:to|for)|rarely|"
    r"seldom|hardly(?: ever)?|barely|scarcely|put off|putting off|skip|neglect|forget)\b"
)
_AFTER = re.compile(
    r"^(?:[\w']+ ){0,2}?(?:(?:is|are|was)(?: (?:just|really|so|very|such|all))* (?:not|n't|boring|exhausting|"
    r"disgusting|"
    r"overrated|awful|terrible|horrible|gross|a waste|the worst|hard for me|stupid|something i (?:hate|never|"
    r"do not))|"
    r"bores? me|(?:boring|exhausting|disgusting|pointless|stressful)\b|(?:make|makes|making) me (?:sick|ill|"
    r"anxious|sad))"
)


class Clause(NamedTuple):
    """A part of a sentence with one subject, in plain form: lower case, no short forms, figures of speech taken out."""

    text: str
    own: bool
    """Whether it speaks of the person, not of somebody else."""
    past: bool

    def standing(self, start: int, end: int, *, strict: bool = False) -> Standing:
        """Say how the words from `start` to `end` stand in this clause.

        With `strict` a relative just before them has them, also after "with" or "for": "I care for my mother in a
        wheelchair". Without, "I sew with my mother" is about sewing.
        """
        before, after = self.text[:start], self.text[end:].strip()
        if not self.own or _of_kin(before, strict=strict):
            return "other"
        if self.past:
            return "past"
        bare = _NOT_AGAINST.sub(lambda found: " " * len(found.group()), before)
        if _AFTER.search(after):
            return "dislikes"
        if _SELDOM.search(bare):
            return "seldom"
        if against := _NEVER.search(bare):
            softly = _SOFTLY.search(bare, against.end()) or _LITTLE.search(after)
            return "dislikes" if softly and not _HARD.search(bare) else "never"
        if _DISLIKES.search(bare):
            return "dislikes"
        return "wish" if _WISH.search(before) else "does"


def plain_sentence(sentence: str) -> str:
    """Return a sentence in the form in which words are looked for: "I'm 34-year-old" is "i am 34 year old"."""
    text = sentence.lower().replace("’", "'").replace("`", "'")
    for short, full in _SHORT:
        text = re.sub(short, full, text)
    text = re.sub(r"\b(if|when) i am not (?=\w+ing\b)", r"\1 i am ", text)
    text = re.sub(r"(\d)(?=[a-z]{3})|[-–—/\"()!?.*]+(?!\d)", lambda found: f"{found.group(1) or ''} ", text)
    return re.sub(r"\s+", " ", text).strip(" ,")


def unfigured(text: str) -> str:
    """Take figures of speech and similes out of a plain sentence: "i run a small shop" does not say "run"."""
    return re.sub(r" {2,}", " ", _SIMILE.sub("", _FIGURES.sub("_", text))).strip(" ,")


def clauses(sentence: str) -> list[Clause]:
    """Split a sentence into clauses; one without a subject goes on with that of the clause before."""
    found: list[Clause] = []
    start = 0
    text = unfigured(plain_sentence(sentence))
    own = _LEFT_OVER.search(text) is None
    cuts = [*_BREAKS.finditer(text), None]
    for cut in cuts:
        part = text[start : cut.start() if cut else len(text)].strip(" ,")
        start = cut.end() if cut else start
        if part:
            if own and _VERB_ONLY.search(part):
                part = f"i {part}"
            own = _speaks_of_self(part, found, own)
            found.append(Clause(part, own, bool(_PAST.search(part)) and not _STILL.search(part)))
    return found


def _speaks_of_self(part: str, before: list[Clause], own: bool) -> bool:
    if part.startswith("who "):
        last = before[-1].text if before else ""
        return (
            own and re.search(r"\bi am\b", last) is not None and not re.search(rf"\b{RELATIVE}$|married|dating", last)
        )
    if _OTHERS.search(part):
        return _AND_I.search(part) is not None
    return True if re.search(r"^(?:\w+ ){0,3}?(?:i|we|my|our)\b", part) else own


def _of_kin(before: str, *, strict: bool) -> bool:
    """Whether a relative is the nearest to do something: "watching my son | play", "my husband's | cooking"."""
    kin = [found for found in _KIN.finditer(before) if not _AND_I.search(before, found.start())]
    if not kin:
        return False
    last = kin[-1]
    rest = before[last.end() :].strip()
    if re.search(r"\b(?:i|we)\b", rest) or len(rest.split()) > 3:
        return False
    if last.group().endswith(("'s", "s'")):
        return not rest
    if strict:
        return not _AND_I.search(rest)
    lead = before[: last.start()].strip()
    if rest in ("", "to") and not _PREFACE.search(lead):
        return False
    return bool(_PREFACE.search(lead)) or not (_WITH.search(lead) or "," in rest or rest.startswith("and"))
