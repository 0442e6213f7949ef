MODULE M
  VAR num n;
  PROC main()
    @
    :=1;
    5;
    äö;
    n := 3 $ 4;
    Set do1;
  ENDPROC
ENDMODULE
