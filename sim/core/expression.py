"""A small safe language for force laws: text to a program of a stack machine, by a parser of its own (no `eval`).

expression = term (+|- term)*;  term = factor (*|/ factor)*;  factor = -factor | power;  power = atom [^ exponent]
atom = number | x | v | phi | pi | name(expression[, expression]) | (expression);  exponent = [-] number

Whole exponents from -8 to 8 are products; others take the base as zero where it is negative. Divisors are kept 1e-150
away from zero and roots of negative numbers are zero (`sim.parts.program_kernel`).
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field

from sim.core.errors import Problem, SpecError

MAX_LENGTH, MAX_INSTRUCTIONS, MAX_STACK, MAX_NESTING = 400, 64, 8, 32
VARIABLES = {"x": 1, "v": 2, "phi": 3}
UNARY = {"neg": 14, "sin": 20, "cos": 21, "abs": 22, "sign": 23, "sqrt": 24, "exp": 25, "tanh": 26}
BINARY = {"+": 10, "-": 11, "*": 12, "/": 13, "max": 15, "min": 16}
NUMBER, REAL_POWER, WHOLE_POWER, TABLE = 0, 30, 100, 40
"""Codes: a number, a power by a real number, powers by whole numbers n as 100 + n, the table of a law."""
LARGEST_WHOLE = 8
NUMBERS = r"(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
TOKEN = re.compile(rf"\s*(?:{NUMBERS}|(?P<name>[A-Za-z_]\w*)|(?P<sign>[-+*/^(),]))", re.ASCII)
ALLOWED = "numbers, x, v, phi, pi, + - * / ^ ( ), sin cos abs sign sqrt exp tanh max(a, b) min(a, b)"


@dataclass(frozen=True, kw_only=True)
class Instruction:
    """One step of the stack machine: its code, and the number it carries (0 unless the code needs one)."""

    code: int
    value: float = 0.0


Program = tuple[Instruction, ...]


@dataclass(frozen=True, kw_only=True)
class Token:
    """A piece of the text: `number`, `name`, `sign` or `end`, and where it begins (1 is the first character)."""

    kind: str
    text: str
    position: int


def _refuse(field_name: str, position: int, message: str, given: str, allowed: str = ALLOWED) -> SpecError:
    return SpecError(
        Problem(field=field_name, message=f"at character {position}: {message}", given=given, allowed=allowed)
    )


def tokens(text: str, field_name: str) -> list[Token]:
    """Split a text; SpecError names the first character that is not allowed."""
    if len(text) > MAX_LENGTH:
        raise _refuse(field_name, MAX_LENGTH + 1, "is too long", f"{len(text)} characters", f"{MAX_LENGTH} characters")
    found, at = [], 0
    end = len(text.rstrip())
    while at < end:
        match = TOKEN.match(text, at)
        if match is None:
            at += len(text[at:]) - len(text[at:].lstrip())
            raise _refuse(field_name, at + 1, "is not part of a force law", text[at])
        kind = match.lastgroup or ""
        found.append(Token(kind=kind, text=match[kind], position=match.start(kind) + 1))
        at = match.end()
    return [*found, Token(kind="end", text="the end", position=end + 1)]


@dataclass(kw_only=True)
class _Parser:
    """Recursive descent; `program` grows in the order in which the stack machine runs."""

    field_name: str
    tokens: list[Token]
    at: int = 0
    nesting: int = 0
    program: list[Instruction] = field(default_factory=list)

    @property
    def here(self) -> Token:
        return self.tokens[self.at]

    def take(self) -> Token:
        token = self.here
        self.at += 1
        return token

    def refuse(self, message: str, allowed: str = ALLOWED) -> SpecError:
        return _refuse(self.field_name, self.here.position, message, self.here.text, allowed)

    def expect(self, sign: str) -> None:
        if self.here.kind == "end" or self.here.text != sign:
            raise self.refuse(f"{sign!r} is expected", sign)
        self.at += 1

    def is_sign(self, signs: str) -> bool:
        return self.here.kind == "sign" and self.here.text in signs

    def emit(self, code: int, value: float = 0.0) -> None:
        if len(self.program) >= MAX_INSTRUCTIONS:
            raise self.refuse("the law has too many steps", f"{MAX_INSTRUCTIONS} numbers, variables and operations")
        self.program.append(Instruction(code=code, value=value))

    def chain(self, signs: str, operand: Callable[[], None]) -> None:
        """Operands joined by left-associative signs."""
        operand()
        while self.is_sign(signs):
            code = BINARY[self.take().text]
            operand()
            self.emit(code)

    def expression(self) -> None:
        self.nesting += 1
        if self.nesting > MAX_NESTING:
            raise self.refuse("is nested too deeply", f"{MAX_NESTING} levels")
        self.chain("+-", self.term)
        self.nesting -= 1

    def term(self) -> None:
        self.chain("*/", self.factor)

    def factor(self) -> None:
        signs = 0
        while self.is_sign("+-"):
            signs += self.take().text == "-"
        self.power()
        if signs % 2:
            self.emit(UNARY["neg"])

    def power(self) -> None:
        self.atom()
        if self.is_sign("^"):
            self.take()
            negative = self.is_sign("-")
            self.at += negative
            if self.here.kind != "number":
                raise self.refuse("an exponent must be a number", "a number")
            value = float(self.take().text) * (-1.0 if negative else 1.0)
            if value == round(value) and abs(value) <= LARGEST_WHOLE:
                self.emit(WHOLE_POWER + round(value))
            elif not abs(value) <= MAX_STACK:
                self.at -= 1
                raise self.refuse("the exponent is out of bounds", f"-{MAX_STACK} to {MAX_STACK}")
            else:
                self.emit(REAL_POWER, value)

    def atom(self) -> None:
        token = self.here
        if token.kind == "number":
            value = float(self.take().text)
            if value == float("inf"):
                self.at -= 1
                raise self.refuse("the number is too large", "up to 1.7e308")
            self.emit(NUMBER, value)
        elif token.kind == "name":
            self.named()
        elif self.is_sign("("):
            self.take()
            self.expression()
            self.expect(")")
        else:
            raise self.refuse("a number, a variable, a function or '(' is expected")

    def named(self) -> None:
        name = self.here.text
        if name == "pi":
            self.take()
            self.emit(NUMBER, 3.141592653589793)
        elif name in VARIABLES:
            self.take()
            self.emit(VARIABLES[name])
        elif name != "neg" and (name in UNARY or name in BINARY):
            self.take()
            self.expect("(")
            self.expression()
            if name in BINARY:
                self.expect(",")
                self.expression()
            self.expect(")")
            self.emit(UNARY.get(name) or BINARY[name])
        else:
            raise self.refuse("unknown name")


def stack_depth(program: Program) -> int:
    """Largest number of values that wait at once."""
    height, most = 0, 0
    for step in program:
        height += 1 if step.code in (NUMBER, TABLE, *VARIABLES.values()) else 0
        height -= 1 if step.code in BINARY.values() else 0
        most = max(most, height)
    return most


def compiled(text: str, field_name: str = "expression") -> Program:
    """Program of an expression; SpecError names the character and what is allowed."""
    parser = _Parser(field_name=field_name, tokens=tokens(text, field_name))
    parser.expression()
    if parser.here.kind != "end":
        raise parser.refuse("an operator is expected", "+ - * / ^, or the end")
    program = tuple(parser.program)
    depth = stack_depth(program)
    if depth > MAX_STACK:
        message = "keeps too many values waiting; write the more deeply nested operand first"
        allowed = f"at most {MAX_STACK}"
        raise SpecError(Problem(field=field_name, message=message, given=depth, allowed=allowed))
    return program
