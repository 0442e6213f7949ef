MODULE M
  VAR num n;
  PROC main()
    Set do1;
    n:=1/n;
    Set do2;
  ENDPROC
ENDMODULE
