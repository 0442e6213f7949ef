MODULE M
  VAR bool a;
  VAR bool b;
  PROC main()
    IF NOT a AND b Set do1;
    IF a OR NOT a AND b Set do2;
    IF a AND NOT b Set do3;
  ENDPROC
ENDMODULE
