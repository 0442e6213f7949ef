MODULE first
  VAR num n:=3;
  PROC main()
    other;
    WaitTime n;
  ENDPROC
ENDMODULE
MODULE second
  PROC other()
    n:=n+1;
  ENDPROC
ENDMODULE
