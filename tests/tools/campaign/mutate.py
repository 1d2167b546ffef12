"""Mutations of JSON texts: of bytes, of tokens, of structure. All from one generator: equal seeds give equal inputs."""
import copy
import json
import re

NUMBERS = ["0", "-0", "-1", "1", "2", "1e300", "-1e300", "1e308", "1e-308", "5e-324", "1e400", "1e-400", "1e19",
           "9007199254740993",
           "2147483648", "-2147483649", "4294967296", "1000000", "100000000", "0.1", "1e-16",
           "3.14159265358979", "00", "0x1", "1.",
           ".5", "NaN", "Infinity", "-", "1e", "1e+", "123456789012345678901234567890"]
STRINGS = ['""', '"ground"', '"."', '"a.b"', '"\\u0000"', '"\\ud800"', '"\\u001b[31m"', '"\u202e"', '"\x7f"',
           '"' + "long" * 40 + '"',
           '"' + "x" * 5000 + '"', '" a"', '"~0/"', '"../../x"',
           '"dynamic"', '"static"', '"fixed"', '"revolute"', '"\\\\"', '"#"']
LAWS = ['{"expression": "abs(sin(1e7*t))"}', '{"expression": "step(sin(1e9*t))"}', '{"expression": "1/t"}',
        '{"expression": "t^t^t^t"}',
        '{"expression": "' + "(" * 70 + "t" + ")" * 70 + '"}', '{"expression": "' + "+".join(["abs(t-1)"] * 200) + '"}',
        '{"expression": "min(t,' + ",".join("1"
                                            for _ in range(300)) + ')"}',
        '{"expression": "sqrt(-1)"}', '{"expression": "exp(1e9*t)"}',
        '{"kind": "table", "times": [0, 0], "values": [1, 2]}',
        '{"kind": "harmonic", "amplitude": 1e308, "omega": 1e308}',
        '{"kind": "product", "factors": [{"expression": "sin(1e6*t)"}, {"expression": "abs(cos(1e6*t))"}]}']
VALUES = NUMBERS + STRINGS + LAWS + ["null", "true", "false", "[]", "{}", "[[]]", "[0,0,0]", "[1,2]", "[0,0,5e-324]",
                                     "[1e308,1e308,1e308]",
                                     "[[1,0,0],[0,1,0],[0,0,1]]"]
TOKEN = re.compile(rb'"(?:\\.|[^"\\])*"|-?[0-9][0-9.eE+-]*|[{}\[\],:]|[a-z]+')


def of_bytes(random, text):
    data = bytearray(text)
    for _ in range(random.choice((1, 1, 1, 2, 5, 20))):
        at = random.randrange(len(data) + 1)
        kind = random.randrange(5)
        if kind == 0 and at < len(data):
            data[at] ^= 1 << random.randrange(8)
        elif kind == 1:
            data[at:at] = bytes([random.randrange(256)])
        elif kind == 2:
            del data[at:at + random.choice((1, 1, 2, 10, 100))]
        elif kind == 3:
            data[at:at] = data[at:at + random.choice((1, 4, 30, 200))]
        else:
            data[at:at] = random.choice((b"\x00", b"\xff", b"\xef\xbb\xbf", b"\x1b[2J", b"\xc3", b"\xed\xa0\x80",
                                         b"[" * 100, b"//", b"/*", b",,"))
    return bytes(data)


def of_tokens(random, text):
    tokens = list(TOKEN.finditer(text))
    if not tokens:
        return of_bytes(random, text)
    pieces, last = [], 0
    chosen = {random.randrange(len(tokens)) for _ in range(random.choice((1, 1, 2, 3)))}
    for i, token in enumerate(tokens):
        pieces.append(text[last:token.start()])
        last = token.end()
        if i not in chosen:
            pieces.append(token.group())
            continue
        kind = random.randrange(5)
        if kind == 0:
            pieces.append(random.choice(VALUES).encode("utf-8"))
        elif kind == 1:
            pieces.append(token.group() * 2)
        elif kind == 2:
            pieces.append(random.choice(tokens).group())
        elif kind == 3:
            pieces.append(random.choice(NUMBERS).encode())
    return b"".join(pieces) + text[last:]


def places(value, found=None):
    """Every (container, key) in a document."""
    found = [] if found is None else found
    for key in (value.keys() if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()):
        found.append((value, key))
        places(value[key], found)
    return found


class Raw:
    """A value that is written without changes."""
    texts = []

    @classmethod
    def mark(cls, text):
        cls.texts.append(text)
        return f"@raw{len(cls.texts) - 1}@"

    @classmethod
    def write(cls, document):
        text = json.dumps(document)
        return re.sub(r'"@raw([0-9]+)@"', lambda m: cls.texts[int(m.group(1))], text)


def change_structure(random, document, keys):
    found = places(document)
    if not found:
        return
    container, key = random.choice(found)
    kind = random.randrange(11)
    if kind == 0:
        del container[key]
    elif kind == 1 and isinstance(container, list):
        container.extend([container[key]] * random.choice((1, 2, 20, 300)))
    elif kind == 2:
        other, other_key = random.choice(found)
        container[key], other[other_key] = copy.deepcopy(other[other_key]), copy.deepcopy(container[key])
    elif kind == 3:
        container[key] = Raw.mark(random.choice(NUMBERS))
    elif kind == 4:
        container[key] = Raw.mark(random.choice(VALUES))
    elif kind == 5 and isinstance(container, dict):
        container[random.choice(keys)] = container[key]
    elif kind == 6 and isinstance(container, dict):
        container[random.choice(keys)] = copy.deepcopy(random.choice(found)[0])
    elif kind == 7:
        depth = random.choice((2, 30, 70))
        container[key] = Raw.mark("[" * depth + "1" + "]" * depth)
    elif kind == 8 and isinstance(container[key], (int, float)) and not isinstance(container[key], bool):
        container[key] = container[key] * random.choice((-1, 0, 1e3, 1e-3, 1e12, 1e-12, 1 + 1e-9))
    elif kind == 9 and isinstance(container[key], str):
        names = [c[k] for c, k in found if isinstance(c[k], str)]
        container[key] = random.choice(names)
    elif kind == 10:
        container[key] = Raw.mark(random.choice(LAWS))


def of_structure(random, text, keys):
    try:
        document = json.loads(text)
    except ValueError:
        return of_bytes(random, text)
    Raw.texts.clear()
    for _ in range(random.choice((1, 1, 1, 2, 3, 6))):
        change_structure(random, document, keys)
    return Raw.write(document).encode("utf-8", "surrogatepass")


def of_overrides(random, text, keys):
    """Arguments of --set: mostly pointers that lead somewhere."""
    document = json.loads(text)
    overrides = []
    for _ in range(random.choice((1, 1, 2, 3))):
        path, at = "", document
        while isinstance(at, (dict, list)) and at and random.random() < 0.85:
            key = random.choice(list(at.keys())) if isinstance(at, dict) else random.randrange(len(at))
            path, at = f"{path}/{key}", at[key]
        if random.random() < 0.3:
            path += "/" + random.choice(keys)
        override = f"{path}={random.choice(VALUES)}"
        if random.random() < 0.15:
            override = of_bytes(random, override.encode("utf-8", "surrogatepass")).decode("utf-8",
                                                                                          "replace").replace("\0", "")
        overrides.append(override)
    return overrides
